/** Theme, language, keyboard, help, tour and settings, as each user has them. */
import { beforeEach, describe, expect, it } from "vitest";
import * as en from "../../web/src/i18n/en/index";
import * as fr from "../../web/src/i18n/fr/index";
import { Dashboard } from "./support/dashboard";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

let server: CovrServer;
let dashboard: Dashboard;

beforeEach(async () => {
  server = await CovrServer.start("[people]\nv_h_mps = 1.8\n");
  dashboard = await Dashboard.open(server.url);
});

describe("theme and language", () => {
  it("are kept for each user, and the theme is there before the page's own script", async () => {
    await sitsDown("Ada");
    await dashboard.page.getByTestId("switch-theme").click();
    await dashboard.page.getByTestId("switch-language").click();
    expect(await wears()).toEqual(["light", "fr"]);
    expect(await dashboard.says("view-live")).toBe("En direct");
    await sitsDown("Grace");
    expect(await wears()).toEqual(["dark", "en"]);
    await sitsDown("Ada");
    expect(await wears()).toEqual(["light", "fr"]);

    // The browser's system is dark: without the module, the theme comes from the small script alone.
    await dashboard.page.route("**/assets/*.js", (route) => route.abort());
    await dashboard.page.reload();
    expect(await dashboard.page.evaluate(() => document.documentElement.dataset["theme"])).toBe("light");
    await dashboard.page.unroute("**/assets/*.js");
    await dashboard.page.reload();
    await until("the page is back", 10_000, async () => (await dashboard.says("link")) === "en direct");
    expect(await wears()).toEqual(["light", "fr"]);
  });

  it("leave no English word of the catalogue, and none of the server, on a French page", async () => {
    await dashboard.page.getByTestId("switch-language").click();
    const french = new Set(textsOf(fr));
    const onlyEnglish = textsOf(en).filter((text) => !french.has(text));
    expect(onlyEnglish.length).toBeGreaterThan(50);
    for (const view of ["live", "scenes", "sessions", "machine", "settings", "help"] as const) {
      await dashboard.page.getByTestId(`view-${view}`).click();
      await dashboard.page.locator("main h1").waitFor({ state: "attached", timeout: 5_000 });
      const shown = await dashboard.page.evaluate(shownTexts);
      expect(shown.length, view).toBeGreaterThan(20);
      expect(shown.filter((text) => onlyEnglish.includes(text)), view).toEqual([]);
      // What the server says in English alone is marked so: nothing is.
      if (view === "settings") await dashboard.page.getByTestId("config-people.v_h_mps").waitFor({ timeout: 5_000 });
      const marked = await dashboard.page.evaluate(() => [...document.querySelectorAll("body [lang=en]")].map((element) => element.textContent));
      expect(marked, view).toEqual([]);
    }
  });
});

describe("the keyboard", () => {
  it("leads everywhere, does nothing while somebody types, and never moves the machine by itself", async () => {
    for (const [key, view] of [["2", "scenario"], ["3", "scenes"], ["4", "sessions"], ["5", "machine"], ["6", "settings"], ["7", "help"], ["1", "live"]] as const) {
      await dashboard.page.keyboard.press(key);
      await until(`the view ${view}`, 5_000, async () => (await dashboard.page.getByTestId(`view-${view}`).getAttribute("aria-current")) === "page");
    }
    await dashboard.page.getByTestId("author").press("t");
    expect(await wears()).toEqual(["dark", "en"]);
    await dashboard.page.locator("body").click({ position: { x: 2, y: 700 } });
    await dashboard.page.keyboard.press("t");
    expect(await wears()).toEqual(["light", "en"]);

    await dashboard.page.keyboard.press("6");
    // A browser changes the view a moment after the key: the next one is for the view that comes.
    await dashboard.page.getByTestId("config-people.v_h_mps").waitFor();
    await dashboard.page.keyboard.press("h");
    await until("the button Home has the focus", 5_000, () => focusIs("home"));
    expect((await server.state()).mode).toBe("disarmed");
    await dashboard.page.keyboard.press("Enter");
    await dashboard.shows("ready", 60_000);
    expect(dashboard.complaints).toEqual([]);
  });

  it("is listed under ?, keeps the focus in the list and gives it back; Esc stops also there", async () => {
    await dashboard.page.getByTestId("disarm").waitFor();
    await dashboard.page.getByTestId("view-scenes").focus();
    await dashboard.page.keyboard.press("?");
    await dashboard.page.getByTestId("shortcuts").waitFor({ timeout: 5_000 });
    await dashboard.picture("shortcuts");
    for (let press = 0; press < 12; press += 1) {
      await dashboard.page.keyboard.press("Tab");
      expect(await dashboard.page.evaluate(() => document.activeElement?.closest("main, nav, .tools") === null), `Tab ${press + 1}`).toBe(true);
    }
    await dashboard.page.keyboard.press("1");
    expect(await dashboard.page.getByTestId("shortcuts").isVisible()).toBe(true);
    await dashboard.page.keyboard.press("Escape");
    await dashboard.shows("latched_stop", 5_000);
    expect(await dashboard.page.getByTestId("shortcuts").isVisible()).toBe(true);
    await dashboard.page.keyboard.press("?");
    await until("the list is gone", 5_000, async () => (await dashboard.page.getByTestId("shortcuts").count()) === 0);
    await until("the focus is back", 5_000, () => focusIs("view-scenes"));
  });

  it("can be turned off but for the stop", async () => {
    await dashboard.page.getByTestId("view-settings").click();
    await dashboard.page.getByTestId("setting-shortcuts").uncheck();
    await dashboard.page.keyboard.press("1");
    await dashboard.page.keyboard.press("t");
    expect(await wears()).toEqual(["dark", "en"]);
    await dashboard.page.keyboard.press("Escape");
    await dashboard.shows("latched_stop", 5_000);
  });
});

describe("help", () => {
  it("is a link away from every rule and from the stop, and says what it does not have", async () => {
    await dashboard.page.getByTestId("rule-R3").getByRole("link").click();
    await until("the rule's help has the focus", 5_000, () => focusIs("help-R3"));
    expect(await dashboard.says("help-R3")).toContain("1.6 m/s");
    expect(await dashboard.says("help-R14")).toContain("not watched");
    await dashboard.page.keyboard.press("Escape");
    await dashboard.page.getByTestId("stop-help").click();
    await until("the stop's help has the focus", 5_000, () => focusIs("help-stop-R4"));
    await server.kill();
    await server.run();
    await dashboard.isLive();
    await until("the banner leads to the stop of the last run", 5_000, async () => (await dashboard.page.getByTestId("stop-help").getAttribute("href")) === "#/help/stop/restart");
    await dashboard.page.evaluate(() => { location.hash = "#/help/R99"; });
    await dashboard.page.getByTestId("help-unknown").waitFor({ timeout: 5_000 });
    await dashboard.picture("help");
  });
});

describe("the tour", () => {
  it("comes at the first visit, never lies on the stop, is remembered, and starts again from the help", async () => {
    const first = await Dashboard.open(server.url, "dark", true);
    const tour = first.page.getByTestId("tour");
    await tour.waitFor({ timeout: 5_000 });
    const steps: string[] = [];
    while ((await tour.count()) > 0) {
      steps.push((await tour.getAttribute("data-step")) ?? "");
      const [card, stop] = [await tour.boundingBox(), await first.page.getByTestId("stop").boundingBox()];
      if (card === null || stop === null) throw new Error("the card and the stop are there");
      const apart = card.x >= stop.x + stop.width || stop.x >= card.x + card.width || card.y >= stop.y + stop.height || stop.y >= card.y + card.height;
      expect(apart, steps.at(-1)).toBe(true);
      await first.picture(`tour-${steps.length}`);
      await first.page.getByTestId("tour-next").press("Enter");
    }
    expect(steps).toEqual(["mode", "stop", "picture", "rules", "priors", "timeline", "pages"]);
    await first.page.reload();
    await first.isLive();
    expect(await tour.count()).toBe(0);
    await first.page.getByTestId("view-help").click();
    await first.page.getByTestId("start-tour").click();
    await tour.waitFor({ timeout: 5_000 });
    await first.page.keyboard.press("Escape");
    await first.shows("latched_stop", 5_000);
    await first.page.getByTestId("tour-skip").click();
    expect(await tour.count()).toBe(0);
  });
});

describe("settings", () => {
  it("show the configuration in force, what differs from the default, and find a key", async () => {
    await dashboard.page.getByTestId("view-settings").click();
    await dashboard.page.getByTestId("config-people.v_h_mps").waitFor({ timeout: 5_000 });
    const row = await dashboard.says("config-people.v_h_mps");
    for (const part of ["1.8", "1.6", "file", "COVR_PEOPLE__V_H_MPS"]) expect(row).toContain(part);
    await dashboard.page.getByTestId("config-changed").check();
    expect(await dashboard.page.getByTestId("config-control.rate_hz").count()).toBe(0);
    await dashboard.page.getByTestId("config-changed").uncheck();
    await dashboard.page.getByTestId("config-search").fill("RATE loop");
    expect(await dashboard.page.getByTestId("config-control.rate_hz").count()).toBe(1);
    expect(await dashboard.page.getByTestId("config-people.v_h_mps").count()).toBe(0);
    await dashboard.page.getByTestId("config-search").fill("no such key");
    expect(await dashboard.says("config-count")).toContain("0 of");
    await dashboard.picture("settings");
    expect(dashboard.complaints).toEqual([]);
  });
});

async function sitsDown(name: string): Promise<void> {
  await dashboard.page.getByTestId("author").fill(name);
  await dashboard.page.getByTestId("author").press("Tab");
}

async function wears(): Promise<[string | undefined, string]> {
  return dashboard.page.evaluate(() => [document.documentElement.dataset["theme"], document.documentElement.lang]);
}

async function focusIs(testId: string): Promise<boolean> {
  return dashboard.page.evaluate((id) => document.activeElement?.getAttribute("data-testid") === id, testId);
}

/** Every fixed text of a catalogue. */
function textsOf(part: unknown): string[] {
  if (typeof part === "string") return [part];
  return typeof part === "object" && part !== null ? Object.values(part).flatMap(textsOf) : [];
}

/** In the page: every text and name, but those marked as the server's own English. */
function shownTexts(): string[] {
  const found: string[] = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode() !== null) {
    const node = walker.currentNode;
    if (node.parentElement?.closest('[lang="en"]') === null) found.push((node.textContent ?? "").trim());
  }
  for (const name of ["aria-label", "title", "placeholder"]) {
    for (const element of document.querySelectorAll(`[${name}]`)) {
      if (element.closest('[lang="en"]') === null) found.push(element.getAttribute(name) ?? "");
    }
  }
  return found.filter((text) => text !== "");
}
