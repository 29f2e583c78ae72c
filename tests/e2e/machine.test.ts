/** The machine's view: moved by hand while a button is held, and at rest as soon as it is not. */
import { beforeEach, describe, expect, it } from "vitest";
import { Dashboard, distanceTo, speedOf } from "./support/dashboard";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

let server: CovrServer;
let dashboard: Dashboard;

beforeEach(async () => {
  server = await CovrServer.start();
  dashboard = await Dashboard.open(server.url);
  await dashboard.page.getByTestId("view-machine").click();
});

async function home(): Promise<void> {
  await dashboard.page.getByTestId("view-live").click();
  await dashboard.page.getByTestId("home").click();
  await dashboard.shows("ready", 60_000);
  await dashboard.page.getByTestId("view-machine").click();
}

/** Holds the pointer down on a button. */
async function holdDown(testId: string): Promise<void> {
  const box = await dashboard.page.getByTestId(testId).boundingBox();
  if (box === null) throw new Error(`${testId} is not to be seen`);
  await dashboard.page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await dashboard.page.mouse.down();
}

async function moves(): Promise<void> {
  await until("the column moves", 10_000, () => speedOf(dashboard.now) > 0.05);
}

describe("moved by hand", () => {
  it("says why not before the machine is homed", async () => {
    expect(await dashboard.page.getByTestId("jog-right").isEnabled()).toBe(false);
    expect(await dashboard.says("jog-state")).toContain("home first");
  });

  it("moves while the pointer is down and rests when it is up, and the record says so", async () => {
    await home();
    expect(await dashboard.says("home-repeatability")).toMatch(/found x [-−]?\d\.\d\d mm and y [-−]?\d\.\d\d mm/);
    expect(dashboard.events.map(({ kind }) => kind)).toContain("homed");
    const [before] = dashboard.now.column.position_m;
    await holdDown("jog-right");
    await moves();
    await until("it says that it moves", 5_000, async () => (await dashboard.says("jog-state")) === "It moves.");
    expect(dashboard.now.column.activity).toBe("jogged");
    await until("it has come 10 cm", 10_000, () => dashboard.now.column.position_m[0] > before + 0.1);
    await dashboard.picture("machine-jogged");
    await dashboard.page.mouse.up();
    await dashboard.rests(20);
    const jogged = dashboard.snapshots.filter(({ column }) => column.activity === "jogged");
    expect(Math.max(...jogged.map(speedOf))).toBeLessThan(0.12);
    await until("the events are there", 5_000, () => dashboard.events.some(({ kind }) => kind === "jog_ended"));
    expect(dashboard.events.map(({ kind }) => kind)).toContain("jog_began");
    expect(dashboard.complaints).toEqual([]);
  });

  it("goes to a place and stops there, by the keyboard, and refuses one outside", async () => {
    await home();
    const [x, y] = dashboard.now.column.position_m;
    await dashboard.page.getByTestId("jog-speed-reduced").check();
    await dashboard.page.getByTestId("jog-x").fill("99");
    await dashboard.page.getByTestId("jog-y").fill(String(y));
    await dashboard.page.getByTestId("jog-go").focus();
    await dashboard.page.keyboard.down("Enter");
    await until("it is refused", 5_000, async () => (await dashboard.says("jog-state")).includes("outside the travel"));
    await dashboard.page.keyboard.up("Enter");
    await dashboard.page.getByTestId("jog-x").fill((x + 0.3).toFixed(2));
    await dashboard.page.getByTestId("jog-go").focus();
    await dashboard.page.keyboard.down("Enter");
    const place = [Number((x + 0.3).toFixed(2)), y] as const;
    await until("it is there", 15_000, () => distanceTo(dashboard.now, place) < 0.005 && speedOf(dashboard.now) < 0.01);
    await dashboard.page.keyboard.up("Enter");
  });

  it("rests when the page that holds the button is gone", async () => {
    await home();
    await holdDown("jog-up");
    await moves();
    await dashboard.page.close();
    await until("the column rests", 5_000, async () => {
      const { column } = await server.state();
      return Math.hypot(...column.velocity_mps) < 0.01;
    });
    const rested = (await server.state()).column.position_m;
    const onlooker = await Dashboard.open(server.url);
    await onlooker.rests(20);
    expect(distanceTo(onlooker.now, [rested[0], rested[1]])).toBeLessThan(0.005);
  });

  it("is stopped by Escape while it is held", async () => {
    await home();
    await holdDown("jog-right");
    await moves();
    await dashboard.page.keyboard.press("Escape");
    await dashboard.shows("latched_stop", 5_000);
    await dashboard.rests(20);
    await dashboard.page.mouse.up();
    expect(await dashboard.page.getByTestId("jog-right").isEnabled()).toBe(false);
  });
});
