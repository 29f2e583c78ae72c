/** kill -9 and a new start, as the page tells it. */
import { beforeEach, expect, it } from "vitest";
import { Dashboard } from "./support/dashboard";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

let server: CovrServer;
let dashboard: Dashboard;

beforeEach(async () => {
  server = await CovrServer.start();
  dashboard = await Dashboard.open(server.url);
});

it("looks stale, comes back by itself, and says why it is latched and what clears it", async () => {
  await dashboard.page.getByTestId("stop").click();
  await dashboard.shows("latched_stop");
  await server.kill();

  await dashboard.page.getByTestId("stale-banner").waitFor({ timeout: 5_000 });
  const age = async (): Promise<number> => Number.parseFloat(await dashboard.says("stale-age"));
  const first = await age();
  await until("the age counts up", 5_000, async () => (await age()) > first);
  expect(await dashboard.page.getByTestId("reset").isDisabled()).toBe(true);
  expect(await dashboard.says("why-not-reset")).toContain("stale");
  expect(await dashboard.page.getByTestId("stop").isEnabled()).toBe(true);
  await dashboard.picture("stale");

  await server.run();
  await dashboard.isLive();
  expect(await dashboard.page.getByTestId("stale-banner").count()).toBe(0);
  await dashboard.shows("latched_stop");
  expect(await dashboard.says("stop-cause")).toContain("R4");
  expect(await dashboard.says("stop-reason")).not.toBe("");
  expect(await dashboard.says("stop-clears-when")).not.toBe("");
  await dashboard.picture("restarted-latched");

  await dashboard.page.getByTestId("reset").click();
  await dashboard.page.getByTestId("reset-reason").fill("the test is over");
  await dashboard.page.getByTestId("reset-confirm").click();
  await dashboard.shows("disarmed");
  expect(await dashboard.page.getByTestId("stop-cause").count()).toBe(0);
  expect(dashboard.complaints).toEqual([]);
});

it("keeps trying a stop that is pressed while the server is dead, until the new one acknowledges it", async () => {
  await server.kill();
  await dashboard.page.getByTestId("stale-banner").waitFor({ timeout: 5_000 });
  await dashboard.page.getByTestId("stop").click();
  await dashboard.page.getByTestId("stop-pending").waitFor({ timeout: 5_000 });
  expect(await dashboard.says("stop-pending")).toContain("NOT ACKNOWLEDGED, retrying");
  await dashboard.picture("not-acknowledged");
  await server.run();
  await dashboard.page.getByTestId("stop-acknowledged").waitFor({ timeout: 10_000 });
  await dashboard.isLive();
  await dashboard.shows("latched_stop");
});
