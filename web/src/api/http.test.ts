import { afterEach, describe, expect, it, vi } from "vitest";
import { changePriors, postStop, Problem, uploadScene } from "./http";

function answers(status: number, body: string): ReturnType<typeof vi.fn<typeof fetch>> {
  const made = vi.fn<typeof fetch>(() => Promise.resolve(new Response(body, { status, statusText: "Words" })));
  vi.stubGlobal("fetch", made);
  return made;
}

afterEach(() => {
  vi.unstubAllGlobals();
});

describe("the server over HTTP", () => {
  it("acknowledges a stop only by saying so", async () => {
    const giveUp = new AbortController().signal;
    answers(200, '{"acknowledged":true,"to_drive_micros":1500}');
    expect(await postStop("smoke", giveUp)).toEqual({ acknowledged: true, to_drive_micros: 1500 });
    answers(200, "{}");
    expect(await postStop(null, giveUp)).toEqual({ acknowledged: false, to_drive_micros: null });
    answers(503, '{"title":"Unavailable","detail":"the drive did not acknowledge"}');
    await expect(postStop(null, giveUp)).rejects.toThrow("the drive did not acknowledge");
  });

  it("refuses a scene place by place", async () => {
    const errors = [{ path: "objects[1].prior", found: "7", expected: "a number from 0 to 1", line: 9, column: 16 }, { path: "", found: 3 }];
    answers(422, JSON.stringify({ title: "Invalid", detail: "two things", errors }));
    const problem = await uploadScene("{}", "Ada").catch((error: unknown) => error);
    if (!(problem instanceof Problem)) throw new Error("a refusal is a problem");
    expect(problem.status).toBe(422);
    expect(problem.errors).toEqual([errors[0], { path: "", found: "3", expected: "", line: null, column: null }]);
  });

  it("is a problem also when the answer is none", async () => {
    answers(502, "<html>");
    await expect(changePriors({ lamp: 0.4 }, "Ada")).rejects.toThrow("502 Words");
  });

  it("sends the document as it was written, and any author's name", async () => {
    const made = answers(201, '{"id":4,"version":1}');
    expect(await uploadScene('{ "a" :1 }', "Zoë 100%")).toEqual({ id: 4, version: 1 });
    expect(made.mock.calls[0]?.[1]).toMatchObject({ method: "POST", body: '{ "a" :1 }', headers: { "X-Covr-Author": "Zo%C3%AB%20100%25" } });
  });
});
