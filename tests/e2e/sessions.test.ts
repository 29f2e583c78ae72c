/** Sessions: one is recorded with a made-up visitor, opened, scrubbed, played, exported and linked to. */
import { readFile } from "node:fs/promises";
import { expect, it } from "vitest";
import type { Session } from "../../web/src/api/types";
import { Dashboard } from "./support/dashboard";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

it("opens a recorded session, moves about in it by slider, keys, frames and events, plays it, and takes it away", async () => {
  const server = await CovrServer.start();
  const dashboard = await Dashboard.open(server.url);
  const { page } = dashboard;
  server.visitor();
  await dashboard.homeAndArm();
  const id = await until("a session runs", 5_000, () => dashboard.now.session_id);

  // While it runs it can be followed: the picture goes on by itself, and says that it is a recording.
  await page.goto(`${server.url}/#/sessions/${id}`);
  await page.getByTestId("follow").click();
  const first = await until("it follows", 20_000, async () => ((await secsShown(dashboard)) > 1 ? await secsShown(dashboard) : null));
  await until("it goes on", 20_000, async () => (await secsShown(dashboard)) > first + 1);
  expect(await dashboard.says("replay-banner")).toContain(`Recording of session ${id}`);
  await until("something was touched", 90_000, async () => (await session(server, id)).reaches > 0);
  await server.json("POST", "/api/v1/disarm", {});
  const ended = await until("the session ended", 20_000, async () => {
    const row = await session(server, id);
    return row.ended_at !== null && row.recorded_frames > 0 ? row : null;
  });

  // The list has it, and finds it.
  await page.getByTestId("replay-back").click();
  const row = page.getByTestId(`session-${id}`);
  await row.filter({ hasText: `${ended.reaches_served} of ${ended.reaches}` }).waitFor({ timeout: 10_000 });
  expect(await row.textContent()).toContain("disarming");
  await page.getByTestId("session-search").fill("no such scene");
  await page.getByTestId("sessions-empty").filter({ hasText: "no such scene" }).waitFor({ timeout: 5_000 });
  await page.getByTestId("session-search").fill(ended.scene.slice(0, 5));
  await page.getByTestId(`session-open-${id}`).click();
  await page.getByTestId("replay-weights").waitFor({ timeout: 10_000 });
  await dashboard.picture("session-opened");

  // By keys on the slider.
  const slider = page.getByTestId("scrub");
  await slider.focus();
  await page.keyboard.press("Home");
  expect(await secsShown(dashboard)).toBe(0);
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  expect(await secsShown(dashboard)).toBe(2);
  await page.keyboard.press("End");
  const length = await secsShown(dashboard);
  expect(length).toBeGreaterThan(3);
  await page.keyboard.press("PageDown");
  expect(await secsShown(dashboard)).toBeCloseTo(Math.max(0, length - 10), 1);

  // Frame by frame: neighbours are as far apart as they were recorded, and going back leads where it was.
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowRight");
  const source = (): Promise<string> => dashboard.says("replay-source");
  await page.getByTestId("frame-on").click();
  await until("it stands at a frame", 5_000, async () => (await slider.inputValue()) !== "1" && !(await source()).includes("between"));
  const stepped = Number(await slider.inputValue());
  await page.getByTestId("frame-on").click();
  await until("it stands at the next", 5_000, async () => Number(await slider.inputValue()) > stepped);
  expect(Number(await slider.inputValue()) - stepped).toBeLessThan(0.5);
  await page.getByTestId("frame-back").click();
  await until("it is back", 5_000, async () => Math.abs(Number(await slider.inputValue()) - stepped) < 1e-6);

  // Event by event; the list keeps to the time.
  await page.getByTestId("event-on").click();
  const current = page.locator('[data-testid=session-event][aria-current="true"]');
  await current.waitFor({ timeout: 5_000 });
  const touch = page.getByTestId("session-event").filter({ hasText: "touch" }).first();
  await touch.click();
  expect(await touch.getAttribute("aria-current")).toBe("true");
  const touchSecs = await secsShown(dashboard);
  await until("its frame is there", 5_000, async () => (await dashboard.says("replay-now")).includes("Following"));
  await dashboard.picture("session-touch");

  // The link keeps the time, and leads to it.
  await until("the address has the time", 5_000, () => Math.abs(Number(/t=([0-9.]+)/.exec(page.url())?.[1]) - touchSecs) < 0.1);
  await page.reload();
  await page.getByTestId("replay-weights").waitFor({ timeout: 10_000 });
  expect(await secsShown(dashboard)).toBeCloseTo(touchSecs, 1);

  // Played fast to its end, where it rests.
  await page.getByTestId("speed").selectOption("20");
  await page.getByTestId("play").click();
  await until("it ends", 60_000, async () => (await secsShown(dashboard)) === length && (await dashboard.says("play")).includes("Play"));

  const { recorded_frames: recorded } = await session(server, id);
  const [csv] = await Promise.all([page.waitForEvent("download"), page.getByTestId("export-csv").click()]);
  const lines = (await readFile(await csv.path(), "utf8")).trim().split(/\r?\n/);
  expect(lines[0]).toMatch(/^time_s,at_micros,mode/);
  expect(lines.length).toBeGreaterThan(recorded);
  const [json] = await Promise.all([page.waitForEvent("download"), page.getByTestId("export-json").click()]);
  const taken = JSON.parse(await readFile(await json.path(), "utf8")) as { session: Session; frames: unknown[]; events: unknown[] };
  expect(taken.session.id).toBe(id);
  expect(taken.frames).toHaveLength(recorded);
  expect(taken.events).not.toHaveLength(0);
  expect(dashboard.complaints).toEqual([]);

  // Links that lead nowhere say so; the stop is still there.
  for (const wrong of ["999", "seven", "-1"]) {
    await page.goto(`${server.url}/#/sessions/${wrong}`);
    await page.getByTestId("no-such-session").filter({ hasText: wrong }).waitFor({ timeout: 5_000 });
  }
  await page.goto(`${server.url}/#/sessions/${id}?t=soon`);
  await page.getByTestId("wrong-time").filter({ hasText: "soon" }).waitFor({ timeout: 5_000 });
  await page.goto(`${server.url}/#/sessions/${id}?t=99999`);
  await page.reload();
  await page.getByTestId("wrong-time").filter({ hasText: "end" }).waitFor({ timeout: 5_000 });
  expect(await secsShown(dashboard)).toBe(length);
  expect(await page.getByTestId("stop").isVisible()).toBe(true);
  expect(dashboard.complaints).toEqual([]);
});

async function session(server: CovrServer, id: number): Promise<Session> {
  return (await server.json("GET", `/api/v1/sessions/${id}`)) as Session;
}

/** The time that the replay shows, s. */
async function secsShown(dashboard: Dashboard): Promise<number> {
  const shown = /^([0-9]+):([0-9.]+)/.exec(await dashboard.page.getByTestId("replay-clock").locator("b").textContent({ timeout: 5_000 }) ?? "");
  if (shown === null) throw new Error("the clock shows no time");
  return Number(shown[1]) * 60 + Number(shown[2]);
}
