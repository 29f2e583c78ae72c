/** The page at /api/docs: every operation and every message, from the server alone. */
import { expect, it } from "vitest";
import { openPage, picture } from "./support/page";
import { CovrServer } from "./support/server";

it("shows every operation and message without a complaint, and asks nobody else", async () => {
  const server = await CovrServer.start();
  const { page, complaints, asked } = await openPage(`${server.url}/api/docs`);
  const http = (await server.json("GET", "/api/v1/openapi.json")) as { paths: Record<string, Record<string, unknown>> };
  const operations = Object.values(http.paths).flatMap((path) => Object.keys(path).filter((key) => METHODS.includes(key)));
  await page.locator(".opblock").first().waitFor({ timeout: 20_000 });
  expect(await page.locator(".opblock").count()).toBe(operations.length);
  expect(operations.length).toBeGreaterThan(20);
  await page.getByTestId("message-pose").waitFor({ timeout: 10_000 });
  const sockets = (await server.json("GET", "/api/v1/asyncapi.json")) as { components: { messages: object } };
  expect(await page.locator("#sockets details").count()).toBe(Object.keys(sockets.components.messages).length);

  // One of each opened: words, answers and examples are there.
  await page.locator(".opblock", { hasText: "/api/v1/stop" }).locator(".opblock-summary").click();
  await page.locator(".opblock.is-open").getByText("503").first().waitFor({ timeout: 10_000 });
  await picture(page, "docs-http");
  await page.getByTestId("message-pose").locator("summary").click();
  expect(await page.getByTestId("message-pose").locator("pre").first().textContent()).toContain("client_time_micros");
  await page.getByTestId("message-pose").scrollIntoViewIfNeeded();
  await picture(page, "docs-sockets");
  // There is no stop on this page, so nothing on it may move the machine.
  expect(await page.getByRole("button", { name: "Try it out" }).count()).toBe(0);
  expect(complaints).toEqual([]);
  expect([...asked].filter((origin) => origin !== server.url)).toEqual([]);
});

const METHODS = ["get", "put", "post", "delete", "patch"];
