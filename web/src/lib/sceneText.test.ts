import { describe, expect, it } from "vitest";
import { MOCK_SCENE } from "../../mock/scene";
import type { SceneError } from "../api/types";
import { drawable, fileNameOf, moveErrors, nameIn, placeErrors, writeJson } from "./sceneText";

function finding(line: number | null, column: number | null = 1): SceneError {
  return { path: "$.x", line, column, found: "7", expected: "less" };
}

describe("findings in a scene's text", () => {
  it("stand at the byte that the server names, also behind letters of several bytes", () => {
    const text = '{\n  "é😀": 7\n}';
    // Two spaces, a quote, é of two bytes, the face of four, a quote, a colon, a space: 7 is byte 13.
    const [placed] = placeErrors(text, [finding(2, 13)]);
    expect(text[placed?.offset ?? 0]).toBe("7");
  });

  it("are told in the order of the text, those without a place first", () => {
    const placed = placeErrors("a\nb\nc", [finding(3), finding(null), finding(9), finding(2)]);
    expect(placed.map(({ line }) => line)).toEqual([null, null, 2, 3]);
  });

  it("move with their lines while the text is mended", () => {
    const before = "a\nb\nc\nd";
    const errors = [finding(1), finding(3), finding(4), finding(null)];
    expect(moveErrors(errors, before, "a\nnew\nnew\nb\nc\nd").map(({ line }) => line)).toEqual([1, 5, 6, null]);
    expect(moveErrors(errors, before, "a\nb\nC\nd").map(({ line }) => line)).toEqual([1, 3, 4, null]);
    expect(moveErrors(errors, before, "a").map(({ line }) => line)).toEqual([1, 1, 1, null]);
  });
});

describe("a scene's text", () => {
  it("is the same document, one field a line and points on one", () => {
    const text = writeJson(MOCK_SCENE);
    expect(JSON.parse(text)).toEqual(MOCK_SCENE);
    expect(text).toContain('"position": [0.9, 3.1, 1.7]');
    expect(text.split("\n").every((line) => line.length < 130)).toBe(true);
    expect(writeJson(JSON.parse(text))).toBe(text);
  });

  it("gives its file a name that every file system takes", () => {
    expect(fileNameOf("La pièce / n° 2", 3)).toBe("la-piece-n-2-v3.json");
    expect(fileNameOf("日本", 1)).toBe("scene-v1.json");
  });

  it("is drawn with the defaults that the server fills in", () => {
    const scene = drawable('{"schema":"covr.scene.v2","name":"n","arena":{"min":[0,0],"max":[1,1]},"objects":[{"id":"a","position":[0,0,1],"shape":{"kind":"sphere","radius":0.1}}]}');
    expect(scene?.objects[0]).toMatchObject({ yaw: 0, prior: 1, enabled: true });
    expect(drawable("{")).toBeNull();
    expect(nameIn('{"name": 3}')).toBeNull();
  });
});
