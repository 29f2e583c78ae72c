import { describe, expect, it } from "vitest";
import { clockOf, play, playerAt, speedBeside, SPEEDS, timeBeside, type Player, type PlayerAction } from "./player";

function after(player: Player, ...actions: readonly PlayerAction[]): Player {
  return actions.reduce(play, player);
}

describe("the replay's clock", () => {
  it("stands until it plays, goes at its speed, and ends with the session", () => {
    const start = playerAt(10, 60);
    expect(after(start, { kind: "tick", passedSecs: 1 })).toEqual(start);
    const playing = after(start, { kind: "speed", speed: 5 }, { kind: "play" }, { kind: "tick", passedSecs: 2 });
    expect(playing).toMatchObject({ atSecs: 20, playing: true });
    expect(after(playing, { kind: "tick", passedSecs: 100 })).toMatchObject({ atSecs: 60, playing: false });
    expect(after(playing, { kind: "tick", passedSecs: 100 }, { kind: "play" })).toMatchObject({ atSecs: 0, playing: true });
  });

  it("never leaves the session, whatever is asked", () => {
    for (const toSecs of [-5, 1e9, NaN, Infinity]) {
      const { atSecs } = after(playerAt(5, 60), { kind: "seek", toSecs });
      expect(atSecs).toBeGreaterThanOrEqual(0);
      expect(atSecs).toBeLessThanOrEqual(60);
    }
    expect(playerAt(1e6, 60).atSecs).toBe(60);
    expect(after(playerAt(5, 60), { kind: "speed", speed: 3 }).speed).toBe(1);
    expect(after(playerAt(0, 0), { kind: "play" }).playing).toBe(false);
    expect(after(playerAt(5, 60), { kind: "play" }, { kind: "tick", passedSecs: -3 }).atSecs).toBe(5);
  });

  it("follows a session that grows until it is moved", () => {
    const following = after(playerAt(0, 60), { kind: "follow", on: true }, { kind: "grown", lengthSecs: 62 }, { kind: "tick", passedSecs: 0.5 });
    expect(following).toMatchObject({ following: true, atSecs: 59, lengthSecs: 62 });
    expect(after(following, { kind: "tick", passedSecs: 9 }).atSecs).toBe(60.5);
    expect(after(following, { kind: "grown", lengthSecs: 90 }, { kind: "tick", passedSecs: 0.1 }).atSecs).toBe(88.5);
    expect(after(following, { kind: "grown", lengthSecs: 61 }).lengthSecs).toBe(62);
    const moved = after(following, { kind: "seek", toSecs: 3 }, { kind: "grown", lengthSecs: 70 });
    expect(moved).toMatchObject({ following: false, atSecs: 3, lengthSecs: 70 });
  });

  it("offers speeds from a tenth to fifty times", () => {
    expect([SPEEDS[0], SPEEDS.at(-1)]).toEqual([0.1, 50]);
    expect(speedBeside(1, 1)).toBe(2);
    expect(speedBeside(0.1, -1)).toBe(0.1);
    expect(speedBeside(50, 1)).toBe(50);
  });

  it("finds the event before and after, not the one that it stands at", () => {
    const times = [1, 2, 2, 5];
    expect(timeBeside(times, 2, 1)).toBe(5);
    expect(timeBeside(times, 2, -1)).toBe(1);
    expect(timeBeside(times, 5, 1)).toBeNull();
    expect(timeBeside([], 0, -1)).toBeNull();
  });

  it("reads like a clock", () => {
    expect([0, 59.96, 61.04, 3723.4].map(clockOf)).toEqual(["0:00.0", "1:00.0", "1:01.0", "1:02:03.4"]);
  });
});
