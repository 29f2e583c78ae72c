/** The desk's panels: priors previewed, applied and set back; the timeline's filters; several clients' links. */
import { beforeEach, expect, it } from "vitest";
import { Dashboard, distanceTo } from "./support/dashboard";
import { room } from "./support/scenes";
import { CovrServer } from "./support/server";
import { standingPerson } from "./support/traces";
import { until } from "./support/until";

let server: CovrServer;
let dashboard: Dashboard;

beforeEach(async () => {
  server = await CovrServer.start();
});

function prior(id: string): number | undefined {
  return dashboard.now.objects.find((object) => object.id === id)?.prior;
}

it("previews priors before they apply, applies them together, and undoes them", async () => {
  // Two balls, mirror images of each other for a person who stands and looks between them.
  await server.useScene(room(4, [{ id: "left", position: [1, 1, 1.2] }, { id: "right", position: [3, 1, 1.2], prior: 0.05 }]));
  const file = await standingPerson(server.folder, 4, [2, 3.4], -Math.PI / 2, 300);
  dashboard = await Dashboard.open(server.url);
  const { page } = dashboard;
  await dashboard.homeAndArm();
  server.visitor("--trace", file);
  await until("the column stands at the left ball", 60_000, () => dashboard.now.column.serves !== null && distanceTo(dashboard.now, [1, 1]) < 0.1);
  await page.getByTestId("author").fill("Grace");
  await page.getByTestId("author").press("Tab");

  await page.getByTestId("prior-right").press("End");
  await page.getByTestId("prior-number-left").fill("0,1");
  await page.getByTestId("prior-number-left").press("Tab");
  await until("the preview says what would be served", 10_000, async () => (await dashboard.says("prior-would-serve")).startsWith("right for "));
  const previewed = dashboard.snapshots.length;
  await until("a second passes", 10_000, () => dashboard.snapshots.length > previewed + 30);
  expect([prior("left"), prior("right")], "a preview changes nothing").toEqual([1, 0.05]);
  expect(distanceTo(dashboard.now, [1, 1])).toBeLessThan(0.2);
  await dashboard.picture("desk-preview");

  await page.getByTestId("prior-apply").press("Enter");
  await until("both are in force", 5_000, () => prior("left") === 0.1 && prior("right") === 1);
  await until("the column stands at the right ball", 30_000, () => distanceTo(dashboard.now, [3, 1]) < 0.3);
  await until("the page says who did it", 5_000, async () => (await dashboard.says("prior-last-change")).includes("Grace: "));

  await page.getByTestId("prior-left").press("Control+z");
  await until("both are set back", 5_000, () => prior("left") === 1 && prior("right") === 0.05);
  expect(dashboard.complaints).toEqual([]);
});

it("refuses wrong input, and asks before it overwrites another game master", async () => {
  dashboard = await Dashboard.open(server.url);
  const { page } = dashboard;
  const id = dashboard.now.objects[0]?.id ?? "";
  const number = page.getByTestId(`prior-number-${id}`);
  for (const [text, why] of [["high", "is not a number"], ["1.5", "is out of range"], ["-1", "is out of range"]] as const) {
    await number.fill(text);
    await number.press("Enter");
    await until(`${text} is refused`, 5_000, async () => (await dashboard.says(`prior-wrong-${id}`)).includes(why));
    expect(await page.getByTestId("prior-apply").isDisabled()).toBe(true);
  }
  const before = prior(id) ?? 0;
  await number.fill("0.3");
  await number.press("Tab");
  await server.json("PATCH", "/api/v1/priors", { [id]: 0.9 });
  await page.getByTestId(`prior-overtaken-${id}`).waitFor({ timeout: 5_000 });
  await page.getByTestId("prior-apply").press("Enter");
  await page.getByTestId("prior-question").waitFor({ timeout: 5_000 });
  expect(prior(id)).toBe(0.9);
  await page.getByTestId("prior-question-yes").press("Enter");
  await until("it is applied all the same", 5_000, () => prior(id) === 0.3);
  expect(before).not.toBe(0.3);
  expect(dashboard.complaints).toEqual([]);
});

it("filters the record, goes back page by page, and shows the particulars", async () => {
  await server.json("POST", "/api/v1/stop", { reason: "drill 0" });
  for (let round = 1; round <= 120; round += 1) await server.json("PATCH", "/api/v1/priors", { [(await server.state()).objects[0]?.id ?? ""]: round / 200 });
  dashboard = await Dashboard.open(server.url);
  const { page } = dashboard;
  const rows = page.getByTestId("events").locator("button.event");
  await page.getByTestId("timeline-group-stops").press("Enter");
  await until("stops alone are shown, older than what the page had", 10_000, async () => (await rows.count()) === 1);
  await rows.first().press("Enter");
  await page.getByTestId("event-details").waitFor({ timeout: 5_000 });
  expect(await dashboard.says("event-details")).toContain("drill 0");
  await page.getByTestId("timeline-group-stops").press("Enter");
  await page.getByTestId("timeline-group-priors").press("Enter");
  await until("a page of prior changes is shown", 10_000, async () => (await rows.count()) === 100);
  await page.getByTestId("timeline-older").press("Enter");
  await until("every prior change is shown", 10_000, async () => (await rows.count()) === 120);
  await page.getByTestId("timeline-search").fill("nothing of that kind");
  await until("nothing passes", 10_000, async () => (await rows.count()) === 0);
  expect(dashboard.complaints).toEqual([]);
});

it("shows every VR client with its link, and how to connect when there is none", async () => {
  dashboard = await Dashboard.open(server.url);
  const { page } = dashboard;
  if ((await page.getByTestId("fold-links").getAttribute("aria-expanded")) === "false") await page.getByTestId("fold-links").press("Enter");
  await until("it says how to connect", 5_000, async () => (await dashboard.says("links-empty")).includes("/ws/v1/client"));
  server.visitor("--seed", "1", "--name", "Ada");
  server.visitor("--seed", "2", "--name", "Berta");
  await until("two clients send poses", 20_000, () => dashboard.now.clients.filter((client) => client.pose_rate_hz > 10).length === 2);
  for (const { name: key } of dashboard.now.clients) {
    await page.getByTestId(`link-${key}`).waitFor({ timeout: 5_000 });
    expect(await page.getByTestId(`link-${key}-pose_rate_hz`).textContent()).toMatch(/\d+ \/s/);
    expect(["good", "weak", "bad"]).toContain(await page.getByTestId(`link-${key}`).getAttribute("data-grade"));
  }
  await dashboard.picture("desk-links");
  expect(dashboard.complaints).toEqual([]);
});
