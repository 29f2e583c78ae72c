/** The game master's cockpit leads a scenario on: cues, a skip and a way back, each with its confirmation, in both languages. */
import { readFile } from "node:fs/promises";
import { expect, it } from "vitest";
import { Dashboard } from "./support/dashboard";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

const ESCAPE = new URL("../../deploy/scenes/escape-room.json", import.meta.url);

it("leads a scenario on by cues, skips and goes back, and says where it is", { timeout: 180_000 }, async () => {
  const server = await CovrServer.start();
  const dashboard = await Dashboard.open(server.url);
  const { page } = dashboard;
  const shows = (testId: string, text: string): Promise<unknown> =>
    until(`${testId} says ${text}`, 10_000, async () => (await dashboard.says(testId)).includes(text));

  await page.getByTestId("view-scenario").click();
  await page.getByTestId("no-scenario").waitFor();
  await server.useScene(JSON.parse(await readFile(ESCAPE, "utf8")));
  await shows("scenario-state", "Reaching for the light");
  await shows("scenario-runs", "It stands");
  expect(await page.getByTestId("cue-lights on").isDisabled()).toBe(true);
  // What is looked at before a start, on every dashboard the same, with who ticked it.
  const other = await Dashboard.open(`${server.url}/#/scenario`);
  await page.getByTestId("check-0").check();
  await shows("checklist-done", "1 of 6 ticked");
  await until("the other dashboard has it", 10_000, async () => (await other.says("checklist-done")).includes("1 of 6 ticked"));
  expect(await other.says("checklist")).toContain("game master, ");

  await page.getByTestId("view-live").click();
  await dashboard.homeAndArm();
  await page.keyboard.press("2");
  await shows("scenario-runs", "It runs.");
  await shows("scenario-enabled", "light bulb in the cupboard, prior 1.00");
  await shows("prior-now-bulb", "1.00");
  await page.getByTestId("note").fill("the visitor laughs");
  await page.getByTestId("note").press("Enter");
  await shows("notes", "the visitor laughs");
  await until("the other dashboard has the note", 10_000, async () => (await other.says("notes")).includes("the visitor laughs"));
  expect(await page.getByTestId("cue-walls").isDisabled()).toBe(true);
  await page.getByTestId("cue-lights on").press("Enter");
  await shows("scenario-state", "The lights are on");
  await shows("variable-lights", "yes");
  await shows("scenario-answer", "the scenario is in the state lit");
  expect(await page.getByTestId("state-lit").getAttribute("aria-current")).toBe("step");
  expect(dashboard.now.objects.every(({ enabled }) => !enabled)).toBe(true);

  // A state in the graph is a button; nothing happens before a reason and a second act.
  await page.getByTestId("state-walls").press("Enter");
  await page.getByTestId("leap").waitFor();
  expect(await page.getByTestId("leap-confirm").isDisabled()).toBe(true);
  await page.getByTestId("leap-reason").fill("the carpet was missed");
  await page.getByTestId("leap-reason").press("Enter");
  await shows("scenario-state", "The magic wall");
  await shows("scenario-next-list", "magic wall, south is touched for 10 s");
  await dashboard.picture("scenario");
  await page.getByTestId("notes").scrollIntoViewIfNeeded();
  await dashboard.picture("scenario-notes");

  await page.getByTestId("rewind").click();
  await page.getByTestId("leap-cancel").click();
  await page.getByTestId("rewind").click();
  await page.getByTestId("leap-reason").fill("too early");
  await page.getByTestId("leap-confirm").click();
  await shows("scenario-state", "The lights are on");
  await page.getByTestId("cue-walls").click();
  await shows("scenario-state", "The magic wall");

  await page.getByTestId("switch-language").click();
  await shows("scenario-runs", "Il se déroule.");
  await shows("scenario-answer", "le scénario est dans l’état walls");
  await shows("scenario-next-list", "est touché pendant 10 s");
  await dashboard.picture("scenario-fr");

  await server.json("POST", "/api/v1/disarm");
  await shows("scenario-left-in", "The magic wall");
  await shows("checklist-done", "0 sur 6 cochés");
  const noted = dashboard.events.find(({ kind }) => kind === "note");
  expect(noted?.detail).toMatchObject({ text: "the visitor laughs", author: "game master" });
  const entered = dashboard.events.filter(({ kind }) => kind === "state_entered").map(({ summary }) => summary);
  expect(entered).toEqual([
    "the scenario is in dark: the machine was armed",
    "the scenario is in lit: cue lights on",
    "the scenario is in walls: skipped: the carpet was missed",
    "the scenario is in lit: gone back: too early",
    "the scenario is in walls: cue walls",
  ]);
  expect(dashboard.complaints).toEqual([]);
});
