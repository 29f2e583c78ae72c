/** Scenes by file: a bad one is refused with its place, a good one is stored and activated. */
import { beforeEach, expect, it } from "vitest";
import { Dashboard } from "./support/dashboard";
import { room } from "./support/scenes";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

let server: CovrServer;
let dashboard: Dashboard;

beforeEach(async () => {
  server = await CovrServer.start();
  dashboard = await Dashboard.open(server.url);
});

it("shows where a bad scene is bad, and lists and activates a good one", async () => {
  const good = room(4, [{ id: "lamp", position: [1, 1, 1] }, { id: "door", position: [3, 3, 1] }]) as { name: string; objects: { prior: number }[] };
  good.name = "Two things";
  const bad = structuredClone(good);
  const second = bad.objects[1];
  if (second === undefined) throw new Error("the scene has two objects");
  second.prior = 7;

  await drop("bad.json", JSON.stringify(bad, null, 2));
  const refused = dashboard.page.getByTestId("scene-error");
  await refused.first().waitFor({ timeout: 5_000 });
  const text = (await refused.first().textContent()) ?? "";
  expect(text).toContain("objects[1].prior");
  expect(text).toContain("7");
  await dashboard.picture("scene-refused");

  await dashboard.page.getByTestId("scene-file").setInputFiles({
    name: "good.json",
    mimeType: "application/json",
    buffer: Buffer.from(JSON.stringify(good)),
  });
  await dashboard.page.getByTestId("upload-accepted").waitFor({ timeout: 5_000 });
  const row = dashboard.page.getByTestId("scenes").getByRole("row").filter({ hasText: "Two things" });
  await row.waitFor({ timeout: 5_000 });
  await row.getByRole("button", { name: "Activate…" }).click();
  await row.getByRole("button", { name: "Activate", exact: true }).click();
  await row.getByText("active", { exact: true }).waitFor({ timeout: 5_000 });
  await until("the machine plays it", 5_000, () => dashboard.now.objects.map((object) => object.id).join() === "lamp,door");
  await dashboard.picture("scene-activated");

  await dashboard.page.getByTestId("view-live").click();
  await dashboard.page.getByTestId("object-lamp").waitFor({ timeout: 5_000 });
  expect(dashboard.complaints).toEqual([]);
});

it("says where a file that is no JSON breaks off", async () => {
  await drop("torn.json", '{\n  "schema": "covr.scene.v1",\n  "name": ');
  await dashboard.page.getByTestId("upload-refused").waitFor({ timeout: 5_000 });
  expect(await dashboard.says("upload-refused")).toContain("torn.json was refused");
});

/** Drags a file onto the page from the live view, as from a file manager. */
async function drop(name: string, text: string): Promise<void> {
  const transfer = await dashboard.page.evaluateHandle(
    ([fileName, content]) => {
      const data = new DataTransfer();
      data.items.add(new File([content], fileName, { type: "application/json" }));
      return data;
    },
    [name, text] as const,
  );
  await dashboard.page.dispatchEvent("main", "dragover", { dataTransfer: transfer });
  await dashboard.page.dispatchEvent("main", "drop", { dataTransfer: transfer });
}
