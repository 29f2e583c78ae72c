/** No view has a serious or critical finding of axe-core: both themes, both languages, laptop and tablet, dialogs open too. */
import { readFile } from "node:fs/promises";
import axe from "axe-core";
import { beforeAll, describe, expect, it } from "vitest";
import { findings } from "./support/axe";
import { Dashboard } from "./support/dashboard";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

const VIEWS = ["live", "scenario", "scenes", "sessions", "machine", "settings", "help"] as const;
const SIZES = [
  { name: "laptop", width: 1366, height: 768 },
  { name: "tablet on its side", width: 1180, height: 820 },
  { name: "tablet upright", width: 820, height: 1180 },
] as const;

beforeAll(() => {
  expect(typeof axe.source).toBe("string");
});

describe("the page", () => {
  it.each([
    ["dark", "en"],
    ["dark", "fr"],
    ["light", "en"],
    ["light", "fr"],
  ] as const)("has no serious finding in any view, %s, %s", { timeout: 240_000 }, async (theme, language) => {
    const server = await CovrServer.start();
    await server.useScene(JSON.parse(await readFile(new URL("../../deploy/scenes/escape-room.json", import.meta.url), "utf8")));
    const dashboard = await opened(server, theme, language);
    await dashboard.homeAndArm();
    server.visitor("--seed", "5");
    await until("somebody is there", 20_000, () => dashboard.now.persons.length > 0);
    for (const { width, height, name } of SIZES) {
      await dashboard.page.setViewportSize({ width, height });
      for (const view of VIEWS) {
        await show(dashboard, view);
        expect(await findings(dashboard), `${view}, ${name}`).toEqual([]);
      }
    }
    expect(dashboard.complaints).toEqual([]);
  });

  it("has none with the list of shortcuts, the tour and a stop on it", { timeout: 120_000 }, async () => {
    const server = await CovrServer.start();
    for (const theme of ["dark", "light"] as const) {
      const dashboard = await Dashboard.open(server.url, theme, true);
      await dashboard.page.getByTestId("tour").waitFor({ timeout: 5_000 });
      expect(await findings(dashboard), `tour, ${theme}`).toEqual([]);
      await dashboard.page.getByTestId("tour-skip").click();
      await dashboard.page.keyboard.press("?");
      await dashboard.page.getByTestId("shortcuts").waitFor({ timeout: 5_000 });
      expect(await findings(dashboard), `shortcuts, ${theme}`).toEqual([]);
      await dashboard.page.keyboard.press("q");
      await dashboard.page.keyboard.press("Escape");
      await dashboard.page.getByTestId("stop-cause").waitFor({ timeout: 5_000 });
      expect(await findings(dashboard), `stopped, ${theme}`).toEqual([]);
      await dashboard.page.getByTestId("reset").click();
      expect(await findings(dashboard), `reset, ${theme}`).toEqual([]);
    }
  });

  it("finds what is wrong: a text of little contrast is a finding", async () => {
    const server = await CovrServer.start();
    const dashboard = await Dashboard.open(server.url);
    await dashboard.page.evaluate(() => {
      const main = document.querySelector("main h1");
      if (main instanceof HTMLElement) main.insertAdjacentHTML("afterend", '<p style="color:#222;background:#000">hardly to be read</p>');
    });
    expect((await findings(dashboard)).join()).toContain("color-contrast");
  });
});

/** A page in a theme and a language. */
async function opened(server: CovrServer, theme: "dark" | "light", language: "en" | "fr"): Promise<Dashboard> {
  const dashboard = await Dashboard.open(server.url, theme);
  if (language === "fr") {
    await dashboard.page.getByTestId("switch-language").click();
    await until("the page is French", 5_000, () => dashboard.page.evaluate(() => document.documentElement.lang === "fr"));
  }
  return dashboard;
}

async function show(dashboard: Dashboard, view: (typeof VIEWS)[number]): Promise<void> {
  await dashboard.page.getByTestId(`view-${view}`).click();
  const sign = { live: "arm", scenario: "state-graph", scenes: "scenes", sessions: "sessions", machine: "machine-axis-x", settings: "config", help: "help-R1" }[view];
  await dashboard.page.getByTestId(sign).waitFor({ timeout: 10_000 });
}
