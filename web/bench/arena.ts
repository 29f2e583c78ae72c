/**
 * How much script one repaint of the top view takes with 5 persons and 200 objects, 20 of them meshes of 5,000
 * triangles: with a still plan, and while it is panned and zoomed so that nothing kept can be used again. Shown as text,
 * for a browser with and without a GPU. `npm run dev`, then open /bench/arena.html.
 */
import type { ObjectDocument, SceneDocument } from "../src/api/types";
import "../src/style/colours.css";
import "../src/style/base.css";
import "../src/style/picture.css";
import "../src/style/desk.css";
import { planOf } from "../src/lib/camera";
import { readPalette } from "../src/lib/theme";
import { TrailKeeper } from "../src/lib/trails";
import { ArenaPainter } from "../src/ui/drawing/arena";
import { Stamps } from "../src/ui/drawing/brush";
import { ALL_LAYERS, boundsOf, type ArenaState } from "../src/ui/drawing/picture";

const [WIDTH_PX, HEIGHT_PX, FRAMES] = [900, 800, 300];

function mesh(): ObjectDocument["shape"] {
  const [rings, sectors] = [51, 50];
  const vertices = Array.from({ length: rings * sectors }, (_, index): [number, number, number] => {
    const [up, round] = [(Math.floor(index / sectors) / (rings - 1)) * Math.PI, ((index % sectors) / sectors) * 2 * Math.PI];
    return [0.15 * Math.sin(up) * Math.cos(round), 0.12 * Math.sin(up) * Math.sin(round), 0.2 * Math.cos(up)];
  });
  const triangles = Array.from({ length: (rings - 1) * sectors * 2 }, (_, index): [number, number, number] => {
    const quad = Math.floor(index / 2);
    const [row, at] = [Math.floor(quad / sectors) * sectors, quad % sectors];
    const next = (at + 1) % sectors;
    return index % 2 === 0 ? [row + at, row + next, row + sectors + at] : [row + next, row + sectors + next, row + sectors + at];
  });
  return { kind: "triangle_mesh", vertices, triangles };
}

const scene: SceneDocument = {
  schema: "covr.scene.v2",
  name: "bench",
  arena: { min: [0, 0], max: [10, 10] },
  column: { size: [0.15, 0.15] },
  objects: Array.from({ length: 200 }, (_, index): ObjectDocument => ({
    id: `object-${index}`,
    label: `Object ${index}`,
    position: [0.5 + (index % 16) * 0.6, 0.5 + Math.floor(index / 16) * 0.7, 1],
    yaw: index,
    shape: index % 10 === 0 ? mesh() : index % 2 === 0 ? { kind: "sphere", radius: 0.08 } : { kind: "box", size: [0.2, 0.12, 0.4] },
    prior: 1,
    enabled: true,
  })),
};

function stateAt(step: number): ArenaState {
  const at = step / 30;
  return {
    column: { position_m: [5 + Math.sin(at), 5], velocity_mps: [Math.cos(at), 0], commanded_m: [5, 5], proxy_m: [5.1, 5], target_m: [7, 6], serves: 0, committed: "object-7", activity: "approaching", homed: true, planned_path_m: Array.from({ length: 20 }, (_, index): [number, number] => [5 + index / 10, 5 + index / 20]) },
    persons: Array.from({ length: 5 }, (_, id) => ({ id, name: `Person ${id}`, head_m: [2 + id * 1.4 + Math.sin(at + id), 3 + Math.cos(at + id), 1.7] as const, yaw_rad: at + id, pitch_rad: -0.2, tracked: true, separation_radius_m: 0.45, distance_m: 1 + 0.2 * Math.sin(at), required_m: 0.85, separation: { radius_m: 0.45, reaction_m: 0.06, braking_m: 0.12, walking_m: 0.2, age_m: 0.02, binding: "walking" as const }, limits_column: id === 0 })),
    objects: scene.objects.map((object, index) => ({ id: object.id, weight: 0.5 + 0.5 * Math.sin(at + index), column_place_m: [object.position[0], object.position[1] - 0.1] as const })),
  };
}

function measure(moving: boolean): number[] {
  const canvas = document.createElement("canvas");
  const ratio = devicePixelRatio;
  [canvas.width, canvas.height] = [WIDTH_PX * ratio, HEIGHT_PX * ratio];
  root?.replaceChildren(canvas);
  const context = canvas.getContext("2d");
  const bounds = boundsOf(scene, null);
  if (context === null || bounds === null) throw new Error("no canvas");
  const [palette, painter, text, keeper] = [readPalette(document.documentElement), new ArenaPainter(), new Stamps(), new TrailKeeper()];
  const frame = { bounds, widthPx: WIDTH_PX, heightPx: HEIGHT_PX, marginPx: 34 };
  const still = planOf(frame, null);
  const times: number[] = [];
  for (let step = 0; step < FRAMES; step += 1) {
    const state = stateAt(step);
    keeper.take(state, (step / 30) * 1e6);
    const plan = moving ? planOf(frame, { centre: [5 + Math.sin(step / 20), 5], zoom: 1 + 0.4 * Math.sin(step / 15) }) : still;
    const began = performance.now();
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    painter.paint({ context, palette, plan, widthPx: WIDTH_PX, heightPx: HEIGHT_PX, ratio, text }, { state, scene, shape: null, trails: keeper.trails() }, ALL_LAYERS);
    times.push(performance.now() - began);
  }
  return times;
}

/** Milliseconds: the middle, the slowest of a hundred, and the first, in which meshes are looked at once. */
function figures(name: string, times: readonly number[]): string {
  const sorted = [...times].sort((one, other) => one - other);
  const at = (share: number): string => (sorted[Math.floor(share * (sorted.length - 1))] ?? 0).toFixed(2);
  return `${name}: median ${at(0.5)} ms, 99th percentile ${at(0.99)} ms, first ${(times[0] ?? 0).toFixed(1)} ms of script a repaint`;
}

const root = document.getElementById("root");
document.documentElement.dataset["theme"] = "dark";
const lines = [figures("still", measure(false)), figures("panned and zoomed", measure(true))];
const shown = document.getElementById("figures");
if (shown !== null) shown.textContent = lines.join("\n");
