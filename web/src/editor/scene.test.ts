import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import type { SceneDocument } from "../api/types";
import { begin, changed, redone, undone } from "./history";
import { newInteraction, onward, pathsOf, withInteraction, withPath } from "./interactions";
import { inOrder } from "./order";
import { readScene } from "./readScene";
import { emptyScene, freeId, moved, withId, withNew, without } from "./scene";
import { withEnabled, withNewState, withoutState, withStateId, withVariableId, withWays } from "./scenario";
import { isAt, selectionAt, within } from "./selection";

const TEXT = readFileSync(new URL("../../../deploy/scenes/escape-room.json", import.meta.url), "utf8");

function escapeRoom(): SceneDocument {
  const read = readScene(TEXT);
  if (read.kind !== "scene") throw new Error(`the example is not read: ${JSON.stringify(read)}`);
  return read.scene;
}

describe("a scene that is read", () => {
  it("is each of the examples, with what may be left out", () => {
    for (const name of ["demo", "kitchen", "paper-demo", "gallery", "escape-room"]) {
      expect(readScene(readFileSync(new URL(`../../../deploy/scenes/${name}.json`, import.meta.url), "utf8")).kind, name).toBe("scene");
    }
    expect(escapeRoom().objects[0]).toMatchObject({ yaw: 0, prior: 1, enabled: true });
    expect(escapeRoom().scenario?.states[2]?.priors?.["wall_north"]).toEqual({ value: 0.33, per_s: 0, per_touch: 0.1, least: 0, most: 0.8 });
    expect(JSON.stringify(escapeRoom().scenario?.states[3]?.transitions?.[0]?.when)).toContain('{"kind":"touching","object":"wall_south","secs":0}');
  });

  it.each([
    ["$.objects[0].position[1]", (scene: { objects: { position: unknown[] }[] }) => { scene.objects[0]?.position.splice(1, 1, "high"); }],
    ["$.objects[0].colour", (scene: { objects: object[] }) => { Object.assign(scene.objects[0] ?? {}, { colour: "red" }); }],
    ["$.objects", (scene: { objects: unknown }) => { scene.objects = {}; }],
    ["$.scenario.states[0].transitions[0].on[0].kind", (scene: SceneDocument) => { Object.assign(scene.scenario?.states[0]?.transitions?.[0]?.on?.[0] ?? {}, { kind: "kick" }); }],
  ])("is told where it is not built as one: %s", (path, damage) => {
    const scene = JSON.parse(TEXT) as never;
    (damage as (scene: unknown) => void)(scene);
    expect(readScene(JSON.stringify(scene))).toEqual({ kind: "broken", path });
  });

  it("is no JSON where it is none", () => {
    expect(readScene("{")).toEqual({ kind: "no_json" });
  });

  it("keeps everything that it has, in the server's order", () => {
    expect(inOrder(escapeRoom())).toEqual(escapeRoom());
    expect(Object.keys(inOrder(escapeRoom()).objects[0] ?? {})).toEqual(["id", "label", "position", "yaw", "shape", "prop", "prior", "enabled"]);
    expect(Object.keys(inOrder(escapeRoom()).scenario?.states[2]?.priors ?? {})).toEqual(["wall_middle", "wall_north", "wall_south"]);
  });
});

describe("what speaks of a thing", () => {
  const spoken = (scene: SceneDocument): string => JSON.stringify({ objects: scene.objects.map(({ prop }) => prop), scenario: scene.scenario });

  it.each([
    ["objects", 1, "wall_south", "south"],
    ["zones", 0, "carpet", "rug"],
    ["props", 3, "panel", "cardboard"],
  ] as const)("follows a new id in %s", (list, index, before, after) => {
    expect(spoken(escapeRoom())).toContain(`"${before}"`);
    const renamed = withId(escapeRoom(), list, index, after);
    expect(spoken(renamed)).not.toContain(`"${before}"`);
    expect(spoken(renamed)).toContain(`"${after}"`);
    // And back again: nothing else was touched.
    expect(withId(renamed, list, index, before)).toEqual(escapeRoom());
  });

  it("follows states and variables", () => {
    const states = withStateId(escapeRoom(), 2, "pushing");
    expect(states.scenario?.states[1]?.transitions?.map(({ to }) => to)).toEqual(["pushing", "pushing"]);
    expect(withVariableId(escapeRoom(), "lights", "lamps").scenario?.states[1]?.entry?.[0]?.variable).toBe("lamps");
    expect(withVariableId(escapeRoom(), "lights", "wall")).toEqual(escapeRoom());
  });

  it("does not follow an id that two things have", () => {
    const twice = withId(escapeRoom(), "objects", 1, "wall_north");
    expect(twice.scenario).toEqual(escapeRoom().scenario);
  });

  it("is enabled no more where a thing is gone; what waits for it is left to the check", () => {
    const less = without(escapeRoom(), "objects", 1);
    expect(less.scenario?.states[2]?.enabled).toEqual(["wall_middle", "wall_north"]);
    expect(Object.keys(less.scenario?.states[2]?.priors ?? {})).toEqual(["wall_middle", "wall_north"]);
    expect(JSON.stringify(less.scenario?.states[2]?.transitions)).toContain("wall_south");
    expect(without(escapeRoom(), "props", 3).objects.filter(({ prop }) => prop === "panel")).toEqual([]);
  });
});

describe("an editor's acts", () => {
  it("begin with nothing and make what the check wants", () => {
    let scene = emptyScene("Mine", [0, 0, 3, 3]);
    scene = withNew(scene, "objects", [1.23456, 2]);
    scene = withNew(scene, "objects", [2, 2]);
    expect(scene.objects.map(({ id, position }) => [id, position])).toEqual([["object", [1.235, 2, 1]], ["object_2", [2, 2, 1]]]);
    scene = withNewState(withNewState(scene));
    scene = withEnabled(scene, 0, "object_2", false);
    scene = withWays(scene, 0, () => [{ on: [{ kind: "cue", name: "next" }], to: "state_2" }]);
    expect(scene.scenario).toEqual({ initial: "state", states: [{ id: "state", enabled: ["object"], transitions: [{ on: [{ kind: "cue", name: "next" }], to: "state_2" }] }, { id: "state_2" }] });
    expect(withoutState(withoutState(scene, 1), 0).scenario).toBeUndefined();
  });

  it("move things and their shapes to the millimetre", () => {
    const carpet = moved(escapeRoom(), "zones", 0, [0.1, -0.2]).zones?.[0]?.shape;
    expect(carpet).toEqual({ kind: "circle", centre: [2.3, 1.2], radius: 0.4 });
    expect(moved(escapeRoom(), "props", 1, [0.05, 0]).props?.[1]?.offset).toEqual([-0.4, 0]);
    expect(freeId(["a", "a_2"], "a")).toBe("a_3");
  });

  it("are undone and done again, moves that follow closely as one", () => {
    let history = changed(begin("a"), "b", null, 0);
    history = changed(changed(history, "c", "move", 1000), "d", "move", 1400);
    expect(undone(history).now).toBe("b");
    expect(undone(undone(history)).now).toBe("a");
    expect(redone(undone(history)).now).toBe("d");
    expect(changed(undone(history), "e", null, 2000).future).toEqual([]);
    expect(undone(changed(history, "e", "move", 9000)).now).toBe("d");
    expect(changed(history, "d", null, 9000)).toBe(history);
  });
});

describe("a finding's path", () => {
  it("names the thing that it is about", () => {
    expect(selectionAt("$.objects[3].shape.radius")).toEqual({ kind: "thing", list: "objects", index: 3 });
    expect(selectionAt("$.scenario.states[12].transitions[0].to")).toEqual({ kind: "state", index: 12 });
    expect(selectionAt("$.scenario.anywhere[0]")).toEqual({ kind: "anywhere" });
    expect(selectionAt("$.arena.max")).toEqual({ kind: "scene" });
    expect([isAt("$.objects[1]", "$.objects[1]"), isAt("$.objects[12]", "$.objects[1]"), isAt("$.objects[1].id", "$.objects[1]")]).toEqual([true, false, true]);
  });

  it("leads to the scene where the thing is gone", () => {
    expect(within(escapeRoom(), { kind: "thing", list: "objects", index: 9 })).toEqual({ kind: "scene" });
    expect(within(emptyScene("x", null), { kind: "variables" })).toEqual({ kind: "scene" });
  });
});

describe("an interaction", () => {
  const escape = escapeRoom();
  const state = escape.scenario?.states.findIndex(({ interactions }) => Object.values(interactions ?? {}).some((one) => "path" in one)) ?? -1;
  const object = Object.entries(escape.scenario?.states[state]?.interactions ?? {}).find(([, one]) => "path" in one)?.[0] ?? "";

  it("keeps its path from one kind that has one to another, and begins with usual values", () => {
    const lead = newInteraction("lead", escape, "bulb", undefined);
    expect(lead).toEqual({ kind: "lead", path: [[3.1, 3.2]], speed: 0.4 });
    expect(newInteraction("transport", escape, "bulb", { kind: "lead", path: [[1, 1], [2, 2]], speed: 0.3 })).toEqual({ kind: "transport", path: [[1, 1], [2, 2]], speed: 0.3 });
    expect(newInteraction("hold", escape, "bulb", lead)).toEqual({ kind: "hold" });
    expect(withInteraction(withInteraction(escape, 1, "bulb", lead), 1, "bulb", null)).toEqual(escape);
  });

  it("has its path pulled, lengthened and shortened, by its state and by its object", () => {
    expect(state).toBeGreaterThanOrEqual(0);
    const [path] = pathsOf(escape, { kind: "state", index: state });
    if (path === undefined) throw new Error("the example has a path");
    expect(path.object).toBe(object);
    expect(pathsOf(escape, { kind: "thing", list: "objects", index: escape.objects.findIndex(({ id }) => id === object) })).toEqual([path]);
    expect(pathsOf(escape, { kind: "scene" })).toEqual([]);
    const longer = withPath(escape, path, (places) => onward(escape, object, places));
    expect(pathsOf(longer, { kind: "state", index: state })[0]?.places.length).toBe(path.places.length + 1);
    expect(withPath(longer, path, (places) => places.slice(0, -1))).toEqual(escape);
    expect(withPath(escape, path, () => [])).toBe(escape);
  });
});
