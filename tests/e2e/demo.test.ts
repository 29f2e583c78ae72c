/** The paper's demonstration, both scenes from start to end by the dashboard's cues, with a visitor for whom contact is armed and taken back. */
import { readFile } from "node:fs/promises";
import { expect, it } from "vitest";
import { Dashboard } from "./support/dashboard";
import { Headset, uncalibrated } from "./support/headset";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

const scene = async (name: string): Promise<unknown> =>
  JSON.parse(await readFile(new URL(`../../deploy/scenes/${name}.json`, import.meta.url), "utf8")) as unknown;

it("plays both scenes by cues, arms contact for the visitor and takes it back", { timeout: 240_000 }, async () => {
  const server = await CovrServer.start();
  const dashboard = await Dashboard.open(server.url);
  const { page } = dashboard;
  const shows = (testId: string, text: string): Promise<unknown> =>
    until(`${testId} says ${text}`, 10_000, async () => (await dashboard.says(testId)).includes(text));
  const cue = async (name: string, leadsTo: string): Promise<void> => {
    await page.getByTestId(`cue-${name}`).click();
    await shows("scenario-state", leadsTo);
  };

  await server.useScene(await scene("escape-room"));
  await dashboard.homeAndArm();
  const headset = await Headset.connect(server.url, "demo");
  await headset.put(uncalibrated([3.3, 0.6, 1.6]));
  await page.keyboard.press("2");
  await shows("scenario-state", "Reaching for the light");
  await shows("interaction", "None is under way");
  await until("Ada is tracked", 10_000, () => Promise.resolve(dashboard.now.persons.some(({ tracked }) => tracked)));
  await cue("lights on", "The lights are on");
  await cue("walls", "The magic wall");
  await cue("wall gives way", "The wall gives way");
  await cue("forest", "The magic broom");

  // R14: nobody is led whom the game master has not armed it for.
  await shows("contact", "No visitor may be touched");
  const [ada] = dashboard.now.persons;
  if (ada === undefined) throw new Error("nobody is in the arena");
  await page.getByTestId("contact-secs").selectOption("30");
  await page.getByTestId(`arm-contact-${String(ada.id)}`).press("Enter");
  await shows("contact", "Armed for Ada");
  await shows("scenario-answer", "armed for Ada");
  await dashboard.picture("contact");
  await page.getByTestId("disarm-contact").click();
  await shows("contact", "No visitor may be touched");
  await page.getByTestId(`arm-contact-${String(ada.id)}`).click();
  await shows("contact", "Armed for Ada");
  await cue("out", "Escaped");
  await server.json("POST", "/api/v1/disarm");
  await shows("contact", "No visitor may be touched");
  const over = (): readonly string[] => dashboard.events.filter(({ kind }) => kind === "contact_over").map(({ summary }) => summary);
  // Events come beside the states, a moment later.
  await until("the end of both is told", 10_000, () => Promise.resolve(over().length >= 2));
  expect(over()).toEqual([
    "contact is armed for Ada no more: taken back",
    "contact is armed for Ada no more: now disarmed",
  ]);

  await server.useScene(await scene("clouds"));
  await shows("scenario-state", "The panel");
  await until("the column rests, and is armed again", 10_000, async () => {
    const rests = dashboard.now.requests.every(({ request, why }) => request !== "arm" || why === null);
    if (rests) await server.json("POST", "/api/v1/arm");
    return rests;
  });
  await shows("scenario-runs", "It runs.");
  await cue("continue", "A chair in the clouds");
  await cue("arrived", "The ghosts");
  await page.getByTestId("switch-language").click();
  await shows("contact", "Aucun visiteur ne peut être touché");
  await dashboard.picture("contact-fr");
  await page.getByTestId("switch-language").click();
  await cue("gone", "The end");
  await shows("scenario-runs", "The scenario has ended.");
  expect(dashboard.complaints).toEqual([]);
});
