/** The scene editor: a designer's path from nothing to a live scene that plays; undo, drafts, files, and what is refused. */
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import type { Locator } from "playwright-core";
import { expect, it } from "vitest";
import type { SceneDocument } from "../../web/src/api/types";
import { findings } from "./support/axe";
import { Dashboard } from "./support/dashboard";
import { Headset } from "./support/headset";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

const ESCAPE = new URL("../../deploy/scenes/escape-room.json", import.meta.url);

it("leads a designer from an empty scene to a checked, live one with three objects, two states and a held touch, which plays", { timeout: 300_000 }, async () => {
  const server = await CovrServer.start();
  const dashboard = await Dashboard.open(server.url);
  const { page } = dashboard;
  const began = Date.now();
  const field = (testId: string): Locator => page.getByTestId(testId);
  const fill = async (testId: string, value: string): Promise<void> => {
    await field(testId).fill(value);
    await field(testId).press("Tab");
  };
  const checks = (text: string): Promise<unknown> => until(`the check says ${text}`, 10_000, async () => (await dashboard.says("editor-check")).includes(text));

  await field("view-scenes").click();
  await field("open-editor").click();
  await field("editor").waitFor();
  // An empty scene is none yet, and says where.
  await checks("1 error");
  expect(await dashboard.says("finding-error")).toContain("$.objects");
  await dashboard.picture("editor-empty");
  await fill("scene-name", "Three things");

  // By keyboard and by form.
  for (const [id, x, y] of [["bell", "1", "1"], ["book", "3", "1"], ["door", "2", "3"]] as const) {
    await field("add-objects").click();
    await fill("thing-id", id);
    await fill("position-x", x);
    await fill("position-y", y);
  }
  await checks("Passes the check: 3 objects.");
  await field("plan-objects-bell").focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Shift+ArrowUp");
  expect([await field("position-x").inputValue(), await field("position-y").inputValue()]).toEqual(["1.1", "1.01"]);
  // By pointer: what is dragged is one step of undo.
  const door = await centreOf(field("plan-objects-door"));
  await page.mouse.move(...door);
  await page.mouse.down();
  await page.mouse.move(door[0] + 20, door[1] + 10);
  await page.mouse.move(door[0] + 40, door[1] + 30, { steps: 5 });
  await page.mouse.up();
  const dragged = Number(await field("position-x").inputValue());
  expect(dragged).toBeGreaterThan(2.1);
  await field("editor-undo").click();
  expect(Number(await field("position-x").inputValue())).toBe(2);
  await field("editor-redo").click();
  expect(Number(await field("position-x").inputValue())).toBe(dragged);
  await field("editor-undo").click();

  // Where the column would lose the arena is said at the object, and mended there.
  await field("choose-objects-book").click();
  await fill("position-x", "3.95");
  await checks("1 warning");
  expect(await field("plan-objects-book").getAttribute("aria-label")).toContain("Warning");
  expect(await dashboard.says("choose-objects-book")).toContain("1 warning");
  await dashboard.picture("editor-room");
  await fill("position-x", "3");
  await checks("Passes the check: 3 objects.");

  // Two states and what leads from one to the other: the bell, touched for two seconds.
  await field("tab-states").click();
  await field("graph-add").click();
  await fill("state-id", "ringing");
  await field("graph-add").click();
  await fill("state-id", "over");
  await field("state-final").check();
  await field("graph-state-ringing").click();
  await field("enable-door").uncheck();
  await field("graph-lead").click();
  await field("graph-state-over").click();
  await field("on-0-0-remove").click();
  await field("add-when-0").click();
  await fill("when-0-secs", "2");
  expect(await field("to-0").inputValue()).toBe("over");
  expect(await field("when-0-object").inputValue()).toBe("bell");
  await checks("1 warning");
  expect(await dashboard.says("finding-warning")).toContain("no state enables the object \"door\"");
  await dashboard.picture("editor-states");
  await field("enable-door").check();
  await checks("Passes the check: 3 objects.");
  // The column keeps its place while the bell is held.
  await field("interaction-bell").selectOption("hold");
  await checks("Passes the check: 3 objects.");
  expect(await findings(dashboard), "editor, states").toEqual([]);

  // Nothing is stored or live before a second act, which says what changes.
  expect(await server.json("GET", "/api/v1/scenes")).toHaveLength(1);
  await field("editor-go").click();
  await field("go-live").waitFor();
  expect(await dashboard.says("go-changes")).toContain("object “bell” added");
  expect(await findings(dashboard), "editor, going live").toEqual([]);
  await dashboard.picture("editor-go-live");
  await field("go-confirm").click();
  await until("it is live", 10_000, async () => (await dashboard.says("editor-outcome")).includes("is live"));
  const spentSecs = (Date.now() - began) / 1000;
  console.log(`from the empty scene to the live one: ${spentSecs.toFixed(0)} s`);
  expect(spentSecs).toBeLessThan(300);
  await until("the machine plays it", 5_000, () => dashboard.now.objects.map(({ id }) => id).join() === "bell,book,door");

  // It plays: somebody comes in and holds a hand to the bell.
  await dashboard.page.getByTestId("view-live").click();
  await dashboard.homeAndArm();
  const headset = await Headset.connect(server.url, "a test's headset");
  await headset.put([2, 2, 1.7]);
  await until("somebody is there", 10_000, () => dashboard.now.persons.length === 1);
  expect(dashboard.now.scenario?.state).toBe("ringing");

  // Now it cannot be replaced: the machine is armed, and somebody is in the arena.
  await page.goto(`${server.url}/#/scenes/edit`);
  await field("editor-go").click();
  await field("go-not-now").waitFor({ timeout: 5_000 });
  expect(await field("go-confirm").isDisabled()).toBe(true);
  await field("go-leave").click();
  await headset.touch("bell", true);
  await until("the held touch leads on", 20_000, () => dashboard.now.scenario?.state === "over");
  expect(dashboard.complaints).toEqual([]);
});

it("keeps a draft over a reload, takes and gives files, compares with the live scene, in French too", { timeout: 180_000 }, async () => {
  const server = await CovrServer.start();
  const dashboard = await Dashboard.open(server.url);
  const { page } = dashboard;
  await server.useScene(JSON.parse(await readFile(ESCAPE, "utf8")));
  await page.goto(`${server.url}/#/scenes/2`);
  await page.getByTestId("scene-edit-plan").click();
  await until("it is loaded", 10_000, async () => (await dashboard.says("editor-outcome")).includes("is loaded"));
  await until("it passes", 10_000, async () => (await dashboard.says("editor-check")).includes("Passes the check"));
  await dashboard.picture("editor-escape-room");

  // A rename is followed by all that speaks of it.
  await page.getByTestId("choose-objects-bulb").click();
  await page.getByTestId("thing-id").fill("lamp");
  await page.getByTestId("thing-id").press("Enter");
  await page.getByTestId("choose-zones-carpet").click();
  await page.getByTestId("plan-handle-0").focus();
  await page.keyboard.press("ArrowRight");
  expect(await page.getByTestId("floor-radius").inputValue()).toBe("0.45");
  await until("it passes again", 10_000, async () => (await dashboard.says("editor-check")).includes("Passes the check"));
  await page.reload();
  await page.getByTestId("choose-objects-lamp").waitFor({ timeout: 10_000 });
  await page.getByTestId("tab-changes").click();
  await until("the changes are told", 10_000, async () => (await dashboard.says("diff-summary")).includes("zone “carpet that says Start” changed: shape"));
  await dashboard.picture("editor-changes");

  const [download] = await Promise.all([page.waitForEvent("download"), page.getByTestId("editor-export").click()]);
  const taken = JSON.parse(await readFile(await download.path(), "utf8")) as SceneDocument;
  expect(taken.objects[0]?.id).toBe("lamp");
  expect(taken.scenario?.states[0]).toMatchObject({ enabled: ["lamp"], priors: { lamp: 1 } });
  expect(taken.scenario?.states[0]?.transitions?.[0]?.on?.[0]).toEqual({ kind: "touch_began", object: "lamp" });

  // Files that are no scenes lose nothing.
  const torn = join(server.folder, "torn.json");
  await writeFile(torn, '{"name": ');
  await page.getByTestId("editor-file").setInputFiles(torn);
  await until("it is no JSON", 5_000, async () => (await dashboard.says("editor-outcome")).includes("torn.json is no JSON"));
  const odd = join(server.folder, "odd.json");
  await writeFile(odd, JSON.stringify({ ...taken, objects: [{ id: "a", position: [1, "high", 1] }] }));
  await page.getByTestId("editor-file").setInputFiles(odd);
  await until("it is not built as one", 5_000, async () => (await dashboard.says("editor-outcome")).includes("$.objects[0].position[1]"));
  expect(await page.getByTestId("choose-objects-lamp").count()).toBe(1);

  // In French: findings too, at what they concern.
  await page.getByTestId("switch-language").click();
  await page.getByTestId("choose-state-walls").click();
  await page.getByTestId("interaction-wall_south").selectOption("transport");
  // Its path is pulled in the room's picture while its state is chosen.
  await page.getByTestId("path-add-wall_south").click();
  const before = Number(await page.getByTestId("path-wall_south-1-x").inputValue());
  await page.getByTestId("tab-room").click();
  await page.getByTestId("plan-path-wall_south-1").focus();
  await page.keyboard.press("ArrowRight");
  expect(Number(await page.getByTestId("path-wall_south-1-x").inputValue())).toBeCloseTo(before + 0.05, 6);
  await dashboard.picture("editor-path");
  await page.getByTestId("tab-states").click();
  await page.getByTestId("prior-wall_north").fill("7");
  await page.getByTestId("prior-wall_north").press("Enter");
  await until("it is refused in French", 10_000, async () => (await dashboard.says("editor-check")).includes("erreurs"));
  const said = await page.getByTestId("form-state").textContent();
  expect(said).toContain("un nombre de 0 à 1");
  await dashboard.picture("editor-fr");
  expect(await findings(dashboard), "editor in French").toEqual([]);
  await page.getByTestId("tab-room").click();
  for (const [width, height] of [[1180, 820], [820, 1180], [1366, 768]] as const) {
    await page.setViewportSize({ width, height });
    expect(await findings(dashboard), `room in French, ${width} px`).toEqual([]);
    if (width === 820) await dashboard.picture("editor-tablet");
  }
  await page.getByTestId("editor-go").click();
  expect(await page.getByTestId("go-confirm").isDisabled()).toBe(true);
  expect(dashboard.complaints).toEqual([]);
});

async function centreOf(thing: Locator): Promise<[number, number]> {
  const box = await thing.locator(".plan-hold").boundingBox();
  if (box === null) throw new Error("it is not drawn");
  return [box.x + box.width / 2, box.y + box.height / 2];
}
