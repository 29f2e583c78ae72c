/** Recorded people for the visitor: real ones from the named folder, or one who just stands somewhere. */
import { createReadStream } from "node:fs";
import { access, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { createGunzip } from "node:zlib";

/** One recorded reach, as far as the tests look into it. */
export interface Reach {
  readonly trial: string;
  readonly mode: string;
  readonly scene: string;
  readonly arena: { readonly x: readonly [number, number]; readonly y: readonly [number, number] };
  readonly targets: readonly { readonly id: string; readonly x: number; readonly y: number; readonly z: number; readonly r: number }[];
  readonly goal: string;
  /** In s from the first frame. */
  readonly events: { readonly reach: number };
  /** The line as it was recorded. */
  readonly line: string;
}

/** Real reaches of a mode of one recorded room, in their order; null on a machine without recordings. */
export async function recordedReaches(mode: string, count: number): Promise<readonly Reach[] | null> {
  const folder = process.env["COVR_TRACES"];
  if (folder === undefined) return null;
  const file = join(folder, "jov2023_reach.jsonl.gz");
  try {
    await access(file);
  } catch {
    return null;
  }
  const found: Reach[] = [];
  for await (const line of createInterface({ input: createReadStream(file).pipe(createGunzip()) })) {
    const reach = { ...(JSON.parse(line) as Omit<Reach, "line">), line };
    if (reach.mode !== mode || (found[0] !== undefined && reach.scene !== found[0].scene)) continue;
    found.push(reach);
    if (found.length === count) break;
  }
  return found;
}

/** Writes a recording of a person who stands still and looks one way for some minutes; its file. */
export async function standingPerson(
  folder: string,
  sizeM: number,
  at: readonly [number, number],
  yawRad: number,
  secs: number,
): Promise<string> {
  const row = [Math.round(at[0] * 1000), Math.round(at[1] * 1000), 1650, Math.round(yawRad * 1000), 0];
  const recording = {
    dataset: "e2e",
    trial: "standing",
    user: "standing",
    arena: { x: [0, sizeM], y: [0, sizeM] },
    targets: [],
    hz: 30,
    cols: ["t_ms", "x_mm", "y_mm", "z_mm", "yaw_mrad", "pitch_mrad"],
    frames: Array.from({ length: secs * 30 }, (_, index) => [Math.round((index * 1000) / 30), ...row]),
  };
  const file = join(folder, "standing.jsonl");
  await writeFile(file, `${JSON.stringify(recording)}\n`);
  return file;
}
