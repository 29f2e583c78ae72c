import { describe, expect, it } from "vitest";
import { MockMachine } from "../../mock/machine";
import { MOCK_SCENE } from "../../mock/scene";
import { parseFrame } from "./frames";

describe("a frame", () => {
  it("is a message when it has the shape of one", () => {
    const machine = new MockMachine(MOCK_SCENE, { latchedBy: null, mode: "following" }, () => undefined);
    machine.step(0.1);
    const snapshot = { type: "snapshot", ...machine.snapshot() };
    expect(parseFrame(JSON.stringify(snapshot))).toEqual({ message: snapshot });
    const answer = { type: "answer", request_id: 4, outcome: "refused", detail: "not homed", to_drive_micros: null };
    expect(parseFrame(JSON.stringify(answer))).toEqual({ message: answer });
  });

  it.each([
    ["{", "a frame that is not JSON"],
    ["7", "a frame without a type"],
    ["null", "a frame without a type"],
    ['{"type":"toString"}', 'a frame of unknown type "toString"'],
    ['{"type":"patch"}', 'a frame of unknown type "patch"'],
    ['{"type":"snapshot","generation":"1"}', "snapshot: generation is not of kind number"],
    ['{"type":"scene","id":1,"version":1,"scene":null}', "scene: scene is not of kind object"],
    ['{"type":"answer","request_id":1,"outcome":"accepted"}', "answer: detail is not of kind string"],
  ])("%s is not", (text, trouble) => {
    expect(parseFrame(text)).toEqual({ trouble });
  });
});
