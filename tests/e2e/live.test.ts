/** The live desk: the picture pans and zooms, the separation rule is told term by term, and each user finds the desk as left. */
import { beforeEach, expect, it } from "vitest";
import { Dashboard } from "./support/dashboard";
import { room } from "./support/scenes";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

let server: CovrServer;
let dashboard: Dashboard;

beforeEach(async () => {
  server = await CovrServer.start();
  await server.useScene(room(4, [{ id: "lamp", position: [1, 1, 1.7] }, { id: "door", position: [3, 3, 1] }]));
  dashboard = await Dashboard.open(server.url);
});

it("pans and zooms by mouse and by keyboard, and never takes a key of the stop", async () => {
  const { page } = dashboard;
  const picture = page.getByTestId("top-view");
  const box = await picture.boundingBox();
  if (box === null) throw new Error("the picture has no size");
  const [x, y] = [box.x + box.width * 0.4, box.y + box.height * 0.4];
  expect(await zoom()).toBe(1);
  await page.mouse.move(x, y);
  await page.mouse.wheel(0, -200);
  await until("the wheel zooms", 5_000, async () => (await zoom()) > 1.2);
  const before = await centre();
  await page.mouse.down();
  await page.mouse.move(x + 60, y, { steps: 4 });
  await page.mouse.up();
  const after = await centre();
  expect(after[0]).toBeLessThan(before[0]);
  expect(after[1]).toBeCloseTo(before[1], 6);
  await page.getByTestId("top-view-fit").click();
  expect(await zoom()).toBe(1);

  await picture.focus();
  await page.keyboard.press("+");
  expect(await zoom()).toBeCloseTo(1.25, 3);
  const still = await centre();
  await page.keyboard.press("ArrowRight");
  expect((await centre())[0]).toBeGreaterThan(still[0]);
  await page.keyboard.press("0");
  expect(await zoom()).toBe(1);
  await page.keyboard.press("Space");
  await dashboard.shows("latched_stop");
  expect(dashboard.complaints).toEqual([]);
});

it("is found again as its user left it, and by another user as it was at first", async () => {
  const { page } = dashboard;
  const left = page.getByTestId("split-left");
  const standard = Number(await left.getAttribute("aria-valuenow"));
  await left.focus();
  await page.keyboard.press("ArrowRight");
  await page.getByTestId("toggle-side-view").click();
  await page.getByTestId("side-y").click();
  await page.getByTestId("toggle-layer-trails").click();
  await page.getByTestId("fold-rules").press("Enter");
  await page.getByTestId("rule-R1").waitFor({ state: "hidden" });
  await page.reload();
  await dashboard.isLive();
  expect(Number(await left.getAttribute("aria-valuenow"))).toBe(standard + 16);
  await page.getByTestId("side-view").waitFor();
  expect(await page.getByTestId("side-y").getAttribute("aria-pressed")).toBe("true");
  expect(await page.getByTestId("toggle-layer-trails").getAttribute("aria-pressed")).toBe("false");
  expect(await page.getByTestId("rule-R1").isVisible()).toBe(false);

  await page.getByTestId("author").fill("Somebody else");
  await page.getByTestId("author").press("Tab");
  await until("the other user's desk", 5_000, async () => Number(await left.getAttribute("aria-valuenow")) === standard);
  expect(await page.getByTestId("side-view").count()).toBe(0);
  await page.getByTestId("rule-R1").waitFor();
});

it("says in words what is asked of whom and where everybody is", async () => {
  server.visitor("--seed", "3");
  const { page } = dashboard;
  await until("somebody is there", 30_000, () => (dashboard.now.persons[0]?.head_m ?? null) !== null);
  const person = dashboard.now.persons[0];
  if (person === undefined) throw new Error("nobody is there");
  await page.getByTestId(`distance-${person.id}`).waitFor();
  // Terms stand on the page exactly when the server tells them.
  const told = (dashboard.now.persons[0]?.separation ?? null) !== null;
  await until("the terms as told", 5_000, async () => (await page.getByTestId(`binding-${person.id}`).count()) === (told ? 1 : 0));
  if (told) {
    expect(await dashboard.says(`binding-${person.id}`)).toMatch(/^(reaction|braking|walking|pose age) binds: \d\.\d\d m$/);
    expect(await dashboard.says(`terms-${person.id}`)).toContain("required");
  }
  await until("the summary", 10_000, async () => (await dashboard.says("top-view-summary")).includes(`${person.name} is at`));
  expect(await page.getByTestId("top-view-summary").getAttribute("aria-live")).toBe("off");
  await page.getByTestId("top-view").focus();
  expect(await page.getByTestId("top-view-summary").getAttribute("aria-live")).toBe("polite");
  await page.getByTestId("toggle-side-view").click();
  await until("heads in the side view", 10_000, async () => ((await page.getByTestId("side-view").getAttribute("aria-label")) ?? "").includes(person.name));
  await dashboard.picture("live-desk");
  expect(dashboard.complaints).toEqual([]);
});

it("has tabs on a tablet, with stop and mode always in view", async () => {
  const { page } = dashboard;
  for (const [width, height] of [[1024, 768], [820, 1180]] as const) {
    await page.setViewportSize({ width, height });
    await page.getByTestId("tab-machine").click();
    await page.keyboard.press("ArrowRight");
    await page.getByTestId("rule-R1").waitFor();
    expect(await page.getByTestId("home").isVisible()).toBe(false);
    for (const always of ["stop", "mode", "top-view"]) {
      const box = await page.getByTestId(always).boundingBox();
      if (box === null) throw new Error(`${always} is out of view`);
      expect(box.y).toBeGreaterThanOrEqual(0);
      expect(box.y + box.height).toBeLessThanOrEqual(height);
      expect(box.x + box.width).toBeLessThanOrEqual(width);
    }
    for (const button of await page.getByTestId("desk").getByRole("button").all()) {
      const box = await button.boundingBox();
      if (box === null) continue;
      expect(Math.min(box.width, box.height), (await button.textContent()) ?? "").toBeGreaterThanOrEqual(44);
    }
    await dashboard.picture(`live-${width}`);
  }
});

async function zoom(): Promise<number> {
  return Number(await dashboard.page.getByTestId("top-view").getAttribute("data-zoom"));
}

async function centre(): Promise<readonly [number, number]> {
  const [x, y] = ((await dashboard.page.getByTestId("top-view").getAttribute("data-centre")) ?? "").split(" ").map(Number);
  return [x ?? Number.NaN, y ?? Number.NaN];
}
