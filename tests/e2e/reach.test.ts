/** A person is served: in at least half of ten reaches the column stands at the object before the hand does. */
import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import { expect, it } from "vitest";
import type { Snapshot } from "../../web/src/api/types";
import { Dashboard, distanceTo } from "./support/dashboard";
import { room } from "./support/scenes";
import { CovrServer } from "./support/server";
import { recordedReaches, type Reach } from "./support/traces";
import { until } from "./support/until";

/** When a hand came to an object, and where the column was then. */
interface Outcome {
  readonly object: string;
  readonly distanceM: number;
}


it("brings the column to the object before the hand in at least half of ten reaches", { timeout: 900_000 }, async () => {
  const reaches = await recordedReaches("fixed", REACHES);
  const size = reaches?.[0] === undefined ? 4 : reaches[0].arena.x[1] - reaches[0].arena.x[0];
  const travel = `[0.0, 0.0, ${size.toFixed(1)}, ${size.toFixed(1)}]`;
  const server = await CovrServer.start(`[machine]\ntravel_m = ${travel}\n`);
  if (reaches === null) await server.useScene(room(size, BALLS));
  const watched = await Dashboard.open(server.url);
  await watched.homeAndArm();

  let outcomes: () => Outcome[];
  if (reaches === null) {
    console.log("no recordings (COVR_TRACES): the visitor is made up");
    server.visitor("--seed", "3");
    outcomes = () => madeUpOutcomes(watched.snapshots);
  } else {
    const file = join(server.folder, "reaches.jsonl");
    await writeFile(file, `${reaches.map((reach) => reach.line).join("\n")}\n`);
    server.visitor("--trace", file);
    outcomes = () => recordedOutcomes(watched, reaches);
  }
  const ten = await until(`${REACHES} reaches`, 840_000, () => {
    const found = outcomes();
    return found.length >= REACHES ? found.slice(0, REACHES) : null;
  });
  await watched.picture("reach");
  console.log(ten.map((entry) => `${entry.object}: ${(entry.distanceM * 100).toFixed(0)} cm`).join("; "));
  expect(ten.filter((entry) => entry.distanceM <= THERE_M).length).toBeGreaterThanOrEqual(REACHES / 2);
  expect(watched.complaints).toEqual([]);
});

/** Each recording begins when its person enters; the recording says when the hand was there. */
function recordedOutcomes(watched: Dashboard, reaches: readonly Reach[]): Outcome[] {
  const entered = watched.events.filter((event) => event.kind === "person_entered");
  const outcomes: Outcome[] = [];
  for (const [index, reach] of reaches.entries()) {
    const began = entered[index];
    if (began === undefined) break;
    const reachedAtMicros = began.at_micros + reach.events.reach * 1e6;
    if (watched.now.at_micros < reachedAtMicros) break;
    const before = watched.snapshots.filter((snapshot) => snapshot.at_micros <= reachedAtMicros).at(-1);
    if (before === undefined) throw new Error(`no snapshot before the reach of ${reach.trial}`);
    outcomes.push(outcomeIn(before, reach.goal));
  }
  return outcomes;
}

/** A made-up person reaches an object when their head is an arm's length from it, having been further off before. */
function madeUpOutcomes(snapshots: readonly Snapshot[]): Outcome[] {
  const outcomes: Outcome[] = [];
  const away = new Set<string>();
  for (const snapshot of snapshots) {
    for (const { id, distance_m } of snapshot.objects) {
      if (distance_m === null) continue;
      if (distance_m > AWAY_M) away.add(id);
      else if (distance_m <= REACHED_M && away.delete(id)) outcomes.push(outcomeIn(snapshot, id));
    }
  }
  return outcomes;
}

function outcomeIn(snapshot: Snapshot, object: string): Outcome {
  const state = snapshot.objects.find((entry) => entry.id === object);
  if (state === undefined) throw new Error(`the active scene has no object ${object}`);
  return { object, distanceM: distanceTo(snapshot, state.column_place_m) };
}

const REACHES = 10;
/** The evaluation's own tolerance: the column within 10 cm of its place is there. */
const THERE_M = 0.1;
const AWAY_M = 0.95;
/** Made-up people stop where they can just reach, give or take ten centimetres. */
const REACHED_M = 0.63;
const BALLS = [
  { id: "near-left", position: [0.8, 0.8, 1.2] },
  { id: "near-right", position: [3.2, 0.8, 1.2] },
  { id: "far", position: [2, 3.2, 1.2] },
] as const;
