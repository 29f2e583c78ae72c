/** The published documents hold against the schemas of their standards. */
import { readFile } from "node:fs/promises";
import { Validator } from "@seriousme/openapi-schema-validator";
import { Ajv } from "ajv";
import addFormats from "ajv-formats";
import { expect, it } from "vitest";
import { CovrServer } from "./support/server";

it("describes both sockets by a document that AsyncAPI 3.0.0 accepts", async () => {
  const server = await CovrServer.start();
  const document = (await server.json("GET", "/api/v1/asyncapi.json")) as { asyncapi: string; info: { title?: string } };
  const schema = JSON.parse(await readFile(new URL("schemas/3.0.0-without-$id.json", import.meta.resolve("@asyncapi/specs/package.json")), "utf8")) as object;
  const ajv = new Ajv({ strict: false, allErrors: true });
  addFormats.default(ajv);
  const accepts = ajv.compile(schema);
  accepts(document);
  expect(accepts.errors ?? []).toEqual([]);
  expect(document.asyncapi).toBe("3.0.0");
  // The schema itself refuses what is no such document.
  delete document.info.title;
  expect(accepts(document)).toBe(false);
});

it("describes HTTP by a document that OpenAPI 3.1 accepts", async () => {
  const server = await CovrServer.start();
  const document = (await server.json("GET", "/api/v1/openapi.json")) as Record<string, unknown>;
  const validator = new Validator();
  const verdict = await validator.validate(document);
  expect(verdict.errors ?? []).toEqual([]);
  expect(verdict.valid).toBe(true);
  expect(validator.version).toBe("3.1");
  expect((await new Validator().validate({ ...document, info: {} })).valid).toBe(false);
});
