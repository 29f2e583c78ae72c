// @vitest-environment happy-dom
import { createRoot } from "solid-js";
import { afterEach, describe, expect, it, vi } from "vitest";
import { createUpload, type Upload } from "./upload";

afterEach(() => {
  vi.unstubAllGlobals();
});

type Answer = readonly [status: number, body: unknown];

/** An upload before a server that answers by the path; what it was sent. */
function uploading(answer: (path: string, text: string) => Answer | Promise<Answer>): { upload: Upload; sent: string[]; end: () => void } {
  const sent: string[] = [];
  vi.stubGlobal("fetch", async (path: string, init: RequestInit) => {
    const text = init.body as string;
    sent.push(`${init.method ?? ""} ${path} ${text}`);
    const [status, body] = await answer(path, text);
    return new Response(JSON.stringify(body), { status });
  });
  return createRoot((end) => ({ upload: createUpload(() => "Ada"), sent, end }));
}

const PASSED: Answer = [200, { valid: true, name: "n", objects: 1 }];
const REFUSED: Answer = [422, { title: "Invalid", detail: "one thing", errors: [{ path: "$.a", line: 2, column: 3, found: "7", expected: "less" }] }];

describe("a scene on its way into the store", () => {
  it("is checked before anything is stored, and stored only when asked", async () => {
    const { upload, sent, end } = uploading((path) => (path.endsWith("/check") ? PASSED : [201, { id: 4, version: 1 }]));
    await upload.send(new File(["{}"], "a.json"));
    await vi.waitFor(() => {
      expect(upload.draft()?.check.kind).toBe("passed");
    });
    expect(sent).toEqual(["POST /api/v1/scenes/check {}"]);
    await upload.store(null);
    expect(sent[1]).toBe("POST /api/v1/scenes {}");
    expect(upload.stored()).toEqual({ file: "a.json", id: 4, version: 1 });
    expect(upload.draft()).toBeNull();
    end();
  });

  it("goes to the scene whose version it is", async () => {
    const { upload, sent, end } = uploading((path) => (path.endsWith("/check") ? PASSED : [200, { id: 3, version: 2 }]));
    upload.open("a.json", "{}", 3);
    await upload.store(3);
    expect(sent[1]).toBe("PUT /api/v1/scenes/3 {}");
    end();
  });

  it("keeps the errors at their lines while it is mended, then checks again", async () => {
    const { upload, end } = uploading((_, text) => (text.includes("good") ? PASSED : REFUSED));
    upload.open("a.json", "{\nbad\n}", null);
    await vi.waitFor(() => {
      expect(upload.draft()?.check.kind).toBe("refused");
    });
    upload.edit("{\n\n\nbad\n}");
    expect(upload.draft()).toMatchObject({ edited: true, check: { kind: "checking", errors: [{ line: 4 }] } });
    upload.edit("{\n\n\ngood\n}");
    await vi.waitFor(() => {
      expect(upload.draft()?.check).toMatchObject({ kind: "passed", errors: [] });
    }, 3000);
    end();
  });

  it("shows no answer about a text that is no longer there", async () => {
    const waiting: ((answer: Answer) => void)[] = [];
    const { upload, end } = uploading((_, text) => (text === "old" ? new Promise<Answer>((resolve) => waiting.push(resolve)) : PASSED));
    upload.open("a.json", "old", null);
    await vi.waitFor(() => {
      expect(waiting).toHaveLength(1);
    });
    upload.edit("new");
    await upload.check();
    expect(upload.draft()?.check.kind).toBe("passed");
    waiting[0]?.(REFUSED);
    await Promise.resolve();
    expect(upload.draft()?.check.kind).toBe("passed");
    end();
  });

  it("does not lose an edited text to a new file, to a refusal, or to a closed tab", async () => {
    const { upload, end } = uploading((path) => (path.endsWith("/check") ? PASSED : [503, { title: "Unavailable", detail: "the database did not answer" }]));
    const closes = (): boolean => {
      const event = new Event("beforeunload", { cancelable: true });
      window.dispatchEvent(event);
      return !event.defaultPrevented;
    };
    await Promise.resolve();
    upload.open("a.json", "{}", null);
    expect(closes()).toBe(true);
    upload.edit("{ }");
    expect(closes()).toBe(false);
    await upload.store(null);
    expect(upload.draft()).toMatchObject({ text: "{ }", trouble: "the database did not answer", storing: false });
    upload.open("b.json", "{}", null);
    expect(upload.former()?.text).toBe("{ }");
    upload.bringBack();
    expect(upload.draft()).toMatchObject({ file: "a.json", text: "{ }" });
    end();
    expect(closes()).toBe(true);
  });
});
