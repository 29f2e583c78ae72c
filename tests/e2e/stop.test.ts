/** The stop in the page: over the socket, and over HTTP when the socket is cut or answers nothing. */
import { beforeEach, describe, expect, it } from "vitest";
import { Dashboard } from "./support/dashboard";
import { SocketCutter } from "./support/proxy";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

let server: CovrServer;
let cutter: SocketCutter;
let dashboard: Dashboard;

beforeEach(async () => {
  server = await CovrServer.start();
  cutter = await SocketCutter.before(server.port);
  dashboard = await Dashboard.open(cutter.url);
  await dashboard.homeAndArm();
  server.visitor("--seed", "7");
  await dashboard.moves(0.4);
});

describe("the stop in the page", () => {
  it("stops the moving column and shows its times", async () => {
    await dashboard.page.getByTestId("stop").click();
    await acknowledgedBy("websocket");
    await dashboard.shows("latched_stop", 5_000);
    await dashboard.rests(30);
    expect((await server.state()).mode).toBe("latched_stop");
    expect(await dashboard.says("stop-reason")).not.toBe("");
    await dashboard.picture("stopped-websocket");
    expect(dashboard.complaints).toEqual([]);
  });

  it.each([
    ["Escape", "author"],
    ["Space", null],
  ])("stops by the key %s", async (key, focus) => {
    if (focus === null) await dashboard.page.locator("body").press(key);
    else await dashboard.page.getByTestId(focus).press(key);
    await acknowledgedBy("websocket");
    await dashboard.shows("latched_stop", 5_000);
  });

  it("stops on every view", async () => {
    for (const view of ["scenes", "sessions"] as const) {
      await dashboard.page.getByTestId(`view-${view}`).click();
      expect(await dashboard.page.getByTestId("stop").isEnabled()).toBe(true);
    }
    await dashboard.page.getByTestId("stop").click();
    await acknowledgedBy("websocket");
    expect((await server.state()).mode).toBe("latched_stop");
  });

  it("is inside the window on a laptop and on a tablet, upright and on its side", async () => {
    for (const [width, height] of [[1366, 768], [1180, 820], [820, 1180]] as const) {
      await dashboard.page.setViewportSize({ width, height });
      const box = await dashboard.page.getByTestId("stop").boundingBox();
      if (box === null) throw new Error(`no stop at ${width} x ${height}`);
      expect(box.x >= 0 && box.y >= 0, `${width} x ${height}`).toBe(true);
      expect(box.x + box.width, `${width} x ${height}`).toBeLessThanOrEqual(width);
      expect(box.y + box.height, `${width} x ${height}`).toBeLessThanOrEqual(height);
    }
  });

  it("stops over HTTP after the WebSocket was cut, while the page says that it is stale", async () => {
    cutter.fate = "cut";
    await dashboard.page.getByTestId("stale-banner").waitFor({ timeout: 5_000 });
    await dashboard.page.getByTestId("stop").click();
    await acknowledgedBy("http");
    await atRest();
    expect(await dashboard.page.getByTestId("stale-banner").isVisible()).toBe(true);
    await dashboard.picture("stopped-http-stale");

    cutter.fate = "passed";
    await dashboard.isLive();
    await dashboard.shows("latched_stop");
    expect(dashboard.complaints).toEqual([]);
  });

  it("stops over HTTP when the WebSocket stays open and answers nothing", async () => {
    cutter.fate = "swallowed";
    await dashboard.page.getByTestId("stop").click();
    await dashboard.page.getByTestId("stop-pending").waitFor({ timeout: 5_000 });
    await acknowledgedBy("http");
    await atRest();
  });
});

/** Waits until the page shows the acknowledgement with both times and the lane. */
async function acknowledgedBy(lane: "websocket" | "http"): Promise<void> {
  const report = dashboard.page.getByTestId("stop-acknowledged");
  await report.waitFor({ timeout: 10_000 });
  const word = lane === "websocket" ? "WebSocket" : "HTTP";
  expect(await report.textContent()).toMatch(
    new RegExp(`stopped: acknowledged in [0-9.]+ ms, ?reached the drive in [0-9.]+ ms, by ${word}`),
  );
}

/** Waits until the server itself says that the machine is stopped and at rest. */
async function atRest(): Promise<void> {
  await until("the machine is latched and at rest", 5_000, async () => {
    const { mode, column } = await server.state();
    return mode === "latched_stop" && Math.hypot(...column.velocity_mps) < 0.01;
  });
}
