/** A headset is calibrated on the page: bad measurements are refused in words, a good one is accepted, and another is put in force. */
import { expect, it } from "vitest";
import { findings } from "./support/axe";
import { Dashboard } from "./support/dashboard";
import { Headset, uncalibrated, type Place } from "./support/headset";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

it("guides from the first point to a calibration in force, and refuses what is bad", { timeout: 180_000 }, async () => {
  const server = await CovrServer.start();
  const headset = await Headset.connect(server.url, "headset 1");
  const dashboard = await Dashboard.open(server.url);
  const { page } = dashboard;
  await page.getByTestId("view-machine").click();
  await until("the headset is offered", 20_000, async () => (await page.getByTestId("calibration-client").inputValue()) === "headset 1");
  await page.getByTestId("calibration-begin").click();
  await page.getByTestId("calibration-making").waitFor();

  // Carried about while it is measured: refused, and no point is taken.
  await take([0, 0, 0], [0, 0, 0], true);
  expect(await dashboard.says("calibration-said")).toContain("mm while it was being measured");
  expect(await page.getByTestId("calibration-point").count()).toBe(0);

  // Along one wall only: points on a line are no calibration, however many.
  for (const x of [0, 0.8, 1.6, 2.4, 3.2, 4]) await take([x, 0, 0], [x, 0, 0]);
  expect(await dashboard.says("calibration-refused")).toContain("nearly on one line");
  expect(await page.getByTestId("calibration-accept").isDisabled()).toBe(true);
  await page.getByTestId("calibration-refused").scrollIntoViewIfNeeded();
  await dashboard.picture("calibration-refused");
  expect(await findings(dashboard)).toEqual([]);
  for (let left = 6; left > 2; left -= 1) {
    await page.getByTestId("calibration-point").last().getByRole("button").click();
    await until("a point is gone", 5_000, async () => (await page.getByTestId("calibration-point").count()) === left - 1);
  }

  const places: readonly Place[] = [[4, 4, 0], [0, 4, 0], [2, 2, 0], [1, 3, 0.8], [3, 1, 0.8]];
  for (const place of places) await take(place, place);
  // Somebody stands 40 cm beside the mark.
  await take([3, 3, 0], [3.4, 3, 0]);
  const row = page.getByTestId("calibration-point").last();
  expect(await row.textContent()).toContain("no: left out");
  expect(await dashboard.says("calibration-result")).toContain("mm off on average");
  await page.getByTestId("calibration-take").scrollIntoViewIfNeeded();
  await dashboard.picture("calibration");
  await page.getByTestId("calibration-accept").click();
  await until("it is accepted", 5_000, async () => (await dashboard.says("calibration-said")) === "Calibration 1 of headset 1 is in force.");
  const version = page.getByTestId("calibration-version").first();
  expect(await version.textContent()).toContain("game master");
  expect(await version.textContent()).toContain("1 left out");

  // The head is where it is, for everybody.
  await until("the head is where it is", 5_000, () => {
    const head = dashboard.now.persons[0]?.head_m ?? null;
    return head !== null && Math.hypot(head[0] - 3.4, head[1] - 3, head[2]) < 0.01;
  });

  // Put out of force, by the keyboard, and only when asked twice.
  await page.getByTestId("calibration-retire").focus();
  await page.keyboard.press("Enter");
  expect((await server.json("GET", "/api/v1/calibrations")) as unknown[]).toMatchObject([{ in_force: true }]);
  await page.getByTestId("calibration-sure").focus();
  await page.keyboard.press("Enter");
  await until("it is out of force", 5_000, async () => (await dashboard.says("calibration-said")).includes("is out of force"));
  await page.getByTestId("calibration-activate").click();
  await page.getByTestId("calibration-sure").click();
  await until("it is in force again", 5_000, async () => (await dashboard.says("calibration-said")).includes("is in force"));

  // In French too.
  await page.getByTestId("switch-language").click();
  await until("the page is French", 5_000, async () => (await version.textContent())?.includes("en vigueur") === true);
  expect(await dashboard.says("calibration-said")).toContain("est en vigueur");
  await version.scrollIntoViewIfNeeded();
  await dashboard.picture("calibration-french");
  expect(dashboard.complaints).toEqual([]);

  /** On a busy computer poses come late or seldom: a point that is refused for that is taken again. */
  async function take(place: Place, really: Place, carried = false): Promise<void> {
    const points = await page.getByTestId("calibration-point").count();
    await headset.put(really, carried);
    const seen = uncalibrated(really);
    await until("the server knows where the headset is", 10_000, () => {
      const head = dashboard.now.persons[0]?.head_m ?? null;
      return carried || (head !== null && Math.hypot(head[0] - seen[0], head[1] - seen[1], head[2] - seen[2]) < 0.01);
    });
    for (const [axis, name] of ["x", "y", "z"].entries()) await page.getByTestId(`calibration-${name}`).fill(String(place[axis]));
    for (let attempt = 0; attempt < 5; attempt += 1) {
      await page.getByTestId("calibration-take").click();
      await until("the point is measured", 10_000, async () => {
        const said = await dashboard.says("calibration-said");
        return said !== "" && !said.includes("Measuring");
      });
      if (carried || (await page.getByTestId("calibration-point").count()) > points) return;
    }
    throw new Error(`no point was taken: ${await dashboard.says("calibration-said")}`);
  }
});
