import { describe, expect, it } from "vitest";
import { MOCK_SCENE } from "../../mock/scene";
import type { SceneDocument } from "../api/types";
import { changesBetween, diffScenes, foldDiff } from "./sceneDiff";

function changed(change: (scene: SceneDocument) => void): SceneDocument {
  const scene = structuredClone(MOCK_SCENE);
  change(scene);
  return scene;
}

describe("two versions of a scene", () => {
  it("are told apart in terms of the room", () => {
    const other = changed((scene) => {
      scene.name = "Darker room";
      const [bulb, door] = scene.objects;
      if (bulb === undefined || door === undefined) throw new Error("the scene has objects");
      bulb.position = [0.9, 3.1, 2.1];
      bulb.prior = 0.5;
      door.enabled = false;
      door.yaw = 1;
      scene.objects = scene.objects.filter(({ id }) => id !== "rock");
      scene.keep_outs = [...(scene.keep_outs ?? []), { id: "plant", shape: { kind: "circle", centre: [1, 1], radius: 0.2 } }];
    });
    const changes = changesBetween(MOCK_SCENE, other);
    expect(changes).toEqual([
      { kind: "field", field: "name" },
      { kind: "removed", part: "objects", name: "Rock" },
      { kind: "moved", name: "Light bulb", byM: expect.closeTo(0.4, 9) as number },
      { kind: "prior", name: "Light bulb", from: 1, to: 0.5 },
      { kind: "switched", name: "North door", on: false },
      { kind: "changed", part: "objects", name: "North door", fields: ["yaw"] },
      { kind: "added", part: "keep_outs", name: "plant" },
    ]);
    expect(changesBetween(MOCK_SCENE, structuredClone(MOCK_SCENE))).toEqual([]);
  });

  it("are told apart in their zones and states", () => {
    const before = changed((scene) => {
      scene.scenario = { initial: "dark", states: [{ id: "dark", label: "Dark" }, { id: "end", final: true }] };
    });
    const other = changed((scene) => {
      scene.zones = [{ id: "mat", shape: { kind: "circle", centre: [1, 1], radius: 0.3 } }];
      scene.scenario = { initial: "lit", states: [{ id: "dark", label: "Dark", enabled: ["bulb"] }, { id: "lit" }] };
    });
    expect(changesBetween(before, other)).toEqual([
      { kind: "added", part: "zones", name: "mat" },
      { kind: "field", field: "scenario" },
      { kind: "removed", part: "states", name: "end" },
      { kind: "changed", part: "states", name: "Dark", fields: ["enabled"] },
      { kind: "added", part: "states", name: "lit" },
    ]);
  });

  it("are compared line by line: both can be read back from the comparison", () => {
    const other = changed((scene) => {
      scene.objects.reverse();
    });
    const lines = diffScenes(MOCK_SCENE, other);
    const side = (skip: "added" | "removed"): unknown => JSON.parse(lines.filter(({ kind }) => kind !== skip).map(({ text }) => text).join("\n"));
    expect(side("added")).toEqual(MOCK_SCENE);
    expect(side("removed")).toEqual(other);
    expect(lines.filter(({ from }) => from !== null).map(({ from }) => from)).toEqual(lines.filter(({ from }) => from !== null).map((_, index) => index + 1));
  });

  it("are shown without what is the same far and wide, of which nothing is lost", () => {
    const other = changed((scene) => {
      scene.description = "Other words.";
    });
    const lines = diffScenes(MOCK_SCENE, other);
    const parts = foldDiff(lines, 2);
    expect(parts.map(({ kind }) => kind)).toEqual(["skipped", "lines", "skipped"]);
    expect(parts.flatMap((part) => part.lines)).toEqual(lines);
    // Two before, the old line and the new, two after.
    expect(parts[1]?.lines.map(({ kind }) => kind)).toEqual(["same", "same", "removed", "added", "same", "same"]);
    expect(foldDiff(diffScenes(MOCK_SCENE, MOCK_SCENE), 2).map(({ kind }) => kind)).toEqual(["skipped"]);
  });
});
