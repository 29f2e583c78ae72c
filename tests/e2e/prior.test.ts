/** A prior that is edited and applied in the page moves the column. */
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

it("moves the column to the object whose prior was raised", async () => {
  // Two balls, mirror images of each other for a person who stands and looks between them.
  await server.useScene(room(4, [{ id: "left", position: [1, 1, 1.2] }, { id: "right", position: [3, 1, 1.2], prior: 0.05 }]));
  const file = await standingPerson(server.folder, 4, [2, 3.4], -Math.PI / 2, 300);
  dashboard = await Dashboard.open(server.url);
  await dashboard.homeAndArm();
  server.visitor("--trace", file);
  await until("the column serves the left ball", 60_000, () => {
    return dashboard.now.column.serves !== null && distanceTo(dashboard.now, [1, 1]) < 0.3;
  });

  await dashboard.page.getByTestId("author").fill("Grace");
  await dashboard.page.getByTestId("author").press("Tab");
  await dashboard.page.getByTestId("prior-right").press("End");
  await dashboard.page.getByTestId("prior-left").press("Home");
  await dashboard.page.getByTestId("prior-apply").press("Enter");
  await until("the page shows the new prior", 5_000, async () => (await dashboard.says("prior-value-right")) === "1.00");
  await until("the server has both", 5_000, () => {
    const prior = (id: string): number | undefined => dashboard.now.objects.find((object) => object.id === id)?.prior;
    return prior("left") === 0 && prior("right") === 1;
  });
  await until("the column stands at the right ball", 30_000, () => distanceTo(dashboard.now, [3, 1]) < 0.3);

  await until("the page says who did it", 5_000, async () => (await dashboard.says("prior-last-change")).includes("Grace: "));
  expect(await dashboard.page.getByTestId("prior-changes").textContent()).toMatch(/Graceleft1\.000\.00/);
  await dashboard.picture("prior");
  expect(dashboard.complaints).toEqual([]);
});
