/** Scenes by file: a bad one is refused at its place in the text and mended there; versions are told apart, seen and activated. */
import { readFile } from "node:fs/promises";
import { beforeEach, expect, it } from "vitest";
import { Dashboard } from "./support/dashboard";
import { room } from "./support/scenes";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

interface SceneText {
  name: string;
  objects: { id: string; prior: number }[];
  keep_outs?: unknown[];
}

let server: CovrServer;
let dashboard: Dashboard;

beforeEach(async () => {
  server = await CovrServer.start();
  dashboard = await Dashboard.open(server.url);
});

it("shows where a bad scene is bad, has it mended there, and stores, shows, activates, compares and downloads it", async () => {
  const { page } = dashboard;
  const good = twoThings();
  const bad = structuredClone(good);
  thing(bad, 0).prior = 9;
  thing(bad, 1).prior = 7;
  const text = JSON.stringify(bad, null, 2);
  await drop("bad.json", text);

  const errors = page.getByTestId("scene-error");
  await errors.first().waitFor({ timeout: 5_000 });
  expect(await errors.count()).toBe(2);
  const lines = text.split("\n");
  const badLines = lines.flatMap((line, index) => (/"prior": [79]/.test(line) ? [index + 1] : []));
  const said = (await errors.nth(1).textContent()) ?? "";
  expect(said).toContain(`line ${badLines[1]}`);
  expect(said).toContain("$.objects[1].prior");
  expect(said).toContain("7");
  // Clicked, and reached by keyboard: the caret stands at the number.
  const field = page.getByTestId("scene-text");
  const caret = (): Promise<string> => field.evaluate((element) => {
    const area = element as HTMLTextAreaElement;
    return area.value.slice(area.selectionStart, area.selectionEnd);
  });
  await errors.nth(1).click();
  expect(await caret()).toBe("7");
  // The line is marked, with the message beside it.
  const mark = page.locator(`[data-testid=scene-mark][data-line="${badLines[1]}"]`);
  expect(await mark.textContent({ timeout: 5_000 })).toContain("found 7");
  await dashboard.picture("scene-refused");
  await page.keyboard.press("F8");
  expect(await caret()).toBe("9");
  await page.keyboard.press("Shift+F8");
  expect(await caret()).toBe("7");
  expect(await page.getByTestId("scene-store").isDisabled()).toBe(true);

  // Mended right there, one after the other; every change is checked again.
  await page.keyboard.type("1");
  await until("one error is left", 5_000, async () => (await errors.count()) === 1);
  await page.keyboard.press("F8");
  await page.keyboard.type("1");
  await page.getByTestId("draft-says").filter({ hasText: "passes the check" }).waitFor({ timeout: 5_000 });

  // Looking elsewhere loses nothing.
  await page.getByTestId("view-live").click();
  await page.getByTestId("view-scenes").click();
  expect(await field.inputValue()).not.toContain('"prior": 7');
  expect(await page.getByTestId("store-as").inputValue()).toBe("new");
  await page.getByTestId("scene-store").click();
  await page.getByTestId("stored-open").click();

  // The picture, and activation with its warning.
  await page.getByTestId("scene-preview").waitFor({ timeout: 5_000 });
  expect(await page.getByTestId("scene-detail").textContent()).toContain("only the scene is drawn");
  // Whether the column is in time from each object to each other.
  await page.getByTestId("pairs").waitFor({ timeout: 5_000 });
  expect(await dashboard.says("pair-lamp-door")).toMatch(/^\d\.\d \/ 6\.6 s/);
  expect(await dashboard.says("pairs-late")).toContain("in time between any two objects");
  await page.getByTestId("scene-activate").click();
  expect(await dashboard.says("activate-dialog")).toContain("Priors start from this document");
  await page.getByTestId("activate-leave").click();
  expect(await page.getByTestId("activate-dialog").count()).toBe(0);
  await page.getByTestId("scene-activate").click();
  await page.getByTestId("activate-confirm").click();
  await until("it is active", 5_000, async () => (await dashboard.says("activation")).includes("is active"));
  await until("the machine plays it", 5_000, () => dashboard.now.objects.map((object) => object.id).join() === "lamp,door");
  await dashboard.picture("scene-activated");

  // Edited as a new version: it is told apart from the first, and can be taken away.
  await page.getByTestId("scene-edit").click();
  await field.fill((await field.inputValue()).replace('"prior": 1', '"prior": 0.5'));
  await page.getByTestId("draft-says").filter({ hasText: "passes the check" }).waitFor({ timeout: 5_000 });
  expect(await page.getByTestId("store-as").inputValue()).not.toBe("new");
  await page.getByTestId("scene-store").click();
  await page.getByTestId("stored-open").click();
  await page.getByTestId("diff").waitFor({ timeout: 5_000 });
  expect(await dashboard.says("diff-summary")).toBe("“lamp” prior 1 → 0.5");
  expect(await page.locator('.diff-line[data-kind="added"]').textContent()).toContain('"prior": 0.5');
  expect(await page.locator('.diff-line[data-kind="removed"]').textContent()).toMatch(/removed: .*"prior": 1(\.0)?,?$/);
  expect(await page.getByTestId("versions").getByRole("row").count()).toBe(3);
  await dashboard.picture("scene-compared");

  const [download] = await Promise.all([page.waitForEvent("download"), page.getByTestId("scene-download").click()]);
  expect(download.suggestedFilename()).toBe("two-things-v2.json");
  const taken = JSON.parse(await readFile(await download.path(), "utf8")) as SceneText;
  expect(taken.objects.map(({ prior }) => prior)).toEqual([0.5, 1]);

  await page.getByTestId("view-live").click();
  await page.getByTestId("object-lamp").waitFor({ timeout: 5_000 });
  expect(dashboard.complaints).toEqual([]);
});

it("says where a file that is no JSON breaks off", async () => {
  await drop("torn.json", '{\n  "schema": "covr.scene.v2",\n  "name": ');
  await dashboard.page.getByTestId("upload-refused").waitFor({ timeout: 5_000 });
  expect(await dashboard.says("draft")).toContain("torn.json");
  expect(await dashboard.page.getByTestId("scene-error").textContent()).toContain("line 3");
});

it("says in the server's words why a scene is not activated, and that a scene does not exist", async () => {
  const { page } = dashboard;
  const around = { ...twoThings(), name: "Shut in" };
  await page.getByTestId("home").click();
  await dashboard.shows("ready", 60_000);
  const [x, y] = dashboard.now.column.position_m;
  around.keep_outs = [{ id: "crate", shape: { kind: "circle", centre: [x, y], radius: 0.2 } }];
  const { id } = (await server.json("POST", "/api/v1/scenes", around)) as { id: number };
  await page.goto(`${server.url}/#/scenes/${id}`);
  await page.getByTestId("scene-activate").click();
  await page.getByTestId("activate-confirm").click();
  await until("the refusal is shown", 5_000, async () => (await dashboard.says("activation")).includes("was not activated"));
  expect(await dashboard.says("activation")).toContain("crate");

  for (const wrong of ["999", "lamp"]) {
    await page.goto(`${server.url}/#/scenes/${wrong}`);
    await page.getByTestId("no-such-scene").filter({ hasText: wrong }).waitFor({ timeout: 5_000 });
  }
  await page.getByTestId("scene-search").fill("no such name");
  await page.getByTestId("scenes-none-found").waitFor({ timeout: 5_000 });
  expect(dashboard.complaints).toEqual([]);
});

function twoThings(): SceneText {
  return { ...(room(4, [{ id: "lamp", position: [1, 1, 1] }, { id: "door", position: [3, 3, 1] }]) as SceneText), name: "Two things" };
}

function thing(scene: SceneText, index: number): { prior: number } {
  const found = scene.objects[index];
  if (found === undefined) throw new Error(`the scene has no object ${index}`);
  return found;
}

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
