/** A person is served: in at least half of ten reaches the column stands at the object before the hand does. */
import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import { afterEach, expect, it } from "vitest";
import type { WireEvent } from "../../web/src/api/types";
import { Dashboard, distanceTo } from "./support/dashboard";
import { room } from "./support/scenes";
import { CovrServer } from "./support/server";
import { recordedReaches } from "./support/traces";
import { until } from "./support/until";

let server: CovrServer | null = null;
let dashboard: Dashboard | null = null;

afterEach(async () => {
  await dashboard?.end();
  await server?.end();
});

it("brings the column to the object before the hand in at least half of ten reaches", { timeout: 600_000 }, async () => {
  const reaches = await recordedReaches("fixed", REACHES + 2);
  const size = reaches?.[0] === undefined ? 4 : reaches[0].arena.x[1] - reaches[0].arena.x[0];
  server = await CovrServer.start(`[machine]\ntravel_m = [0, 0, ${size.toFixed(1)}, ${size.toFixed(1)}]\n`);
  const options = ["--name", "visitor"];
  if (reaches?.[0] === undefined) {
    console.log("no recordings (COVR_TRACES): the visitor is made up");
    await server.useScene(room(4, SYNTHETIC_BALLS));
  } else {
    const { arena, targets } = reaches[0];
    await server.useScene(
      room(
        size,
        targets.map(({ id, x, y, z, r }) => ({ id, position: [x - arena.x[0], y - arena.y[0], z], radius: r })),
      ),
    );
    const file = join(server.folder, "reaches.jsonl");
    await writeFile(file, `${reaches.map((reach) => reach.line).join("\n")}\n`);
    options.push("--trace", file);
  }
  const watched = await Dashboard.open(server.url);
  dashboard = watched;
  await watched.homeAndArm();
  server.visitor(...options);

  const touches = await until(`${REACHES} touches`, 540_000, () => {
    const began = watched.events.filter((event) => event.kind === "touch_began");
    return began.length >= REACHES ? began.slice(0, REACHES) : null;
  });
  const outcomes = touches.map((touch) => outcomeOf(watched, touch));
  await watched.picture("reach");
  console.log(outcomes.map((entry) => `${entry.object}: ${(entry.distanceM * 100).toFixed(0)} cm`).join("; "));
  expect(outcomes.filter((entry) => entry.distanceM <= THERE_M).length).toBeGreaterThanOrEqual(REACHES / 2);
  expect(watched.complaints).toEqual([]);
});

/** How far the column was from where it should stand, in the last snapshot before the touch. */
function outcomeOf(watched: Dashboard, touch: WireEvent): { object: string; distanceM: number } {
  const object = (touch.detail as { object: string }).object;
  const before = watched.snapshots.filter((snapshot) => snapshot.at_micros <= touch.at_micros).at(-1);
  const state = before?.objects.find((entry) => entry.id === object);
  if (before === undefined || state === undefined) throw new Error(`no snapshot shows ${object} before its touch`);
  return { object, distanceM: distanceTo(before, state.column_place_m) };
}

const REACHES = 10;
/** The evaluation's own tolerance: the column within 10 cm of its place is there. */
const THERE_M = 0.1;
const SYNTHETIC_BALLS = [
  { id: "near-left", position: [0.8, 0.8, 1.2] },
  { id: "near-right", position: [3.2, 0.8, 1.2] },
  { id: "far", position: [2, 3.2, 1.2] },
] as const;
