/** The examples under web/examples are VR clients: run as they stand, against the real server. */
import { spawn, spawnSync } from "node:child_process";
import { readFile } from "node:fs/promises";
import { fileURLToPath, pathToFileURL } from "node:url";
import { expect, it } from "vitest";
import { openPage, picture } from "./support/page";
import { CovrServer } from "./support/server";
import { until } from "./support/until";

const EXAMPLES = new URL("../../web/examples/", import.meta.url);
const SCRIPT = fileURLToPath(new URL("visitor.py", EXAMPLES));
/** With the package `websockets`; tests/setup makes one. */
const PYTHON = process.env["COVR_PYTHON"] ?? "python3";

it("is one page and script of at most 60 lines", async () => {
  const texts = await Promise.all(["visitor.html", "visitor.js"].map((file) => readFile(fileURLToPath(new URL(file, EXAMPLES)), "utf8")));
  expect(texts.join("").trimEnd().split("\n").length).toBeLessThanOrEqual(60);
});

it("lets a visitor in from the page that the server serves", async () => {
  const server = await CovrServer.start();
  const { page, complaints } = await openPage(`${server.url}/examples/visitor.html`);
  const visitor = await until("the visitor is in the arena", 20_000, async () => {
    const person = (await server.state()).persons.find(({ name }) => name === "visitor");
    return person?.head_m !== null && person;
  });
  expect(visitor.tracked).toBe(true);
  await until("the page shows the column", 10_000, async () => /column at -?\d/.test((await page.locator("#state").textContent()) ?? ""));
  const before = visitor.head_m ?? [0, 0, 0];
  const box = await page.locator("#room").boundingBox();
  if (box === null) throw new Error("the canvas has no place on the page");
  await page.mouse.move(box.x + box.width * 0.2, box.y + box.height * 0.5);
  await until("the head walks after the mouse", 20_000, async () => {
    const head = (await server.state()).persons[0]?.head_m;
    return head !== null && head !== undefined && Math.hypot(head[0] - before[0], head[1] - before[1]) > 0.5;
  });
  const client = await until("poses come and a clock exchange has closed", 20_000, async () =>
    (await server.state()).clients.find(({ poses, rtt_millis }) => poses > 90 && rtt_millis !== null),
  );
  expect(client.errors).toBe(0);
  await picture(page, "example-visitor");
  expect(complaints).toEqual([]);
});

it("lets a visitor in from the page opened as a file, where the configuration allows that, and else not", async () => {
  const strict = await CovrServer.start();
  const page = pathToFileURL(fileURLToPath(new URL("visitor.html", EXAMPLES)));
  page.searchParams.set("server", strict.url.replace("http", "ws"));
  const refused = await openPage(page.href);
  await until("the page says that it is refused", 10_000, async () => ((await refused.page.locator("#state").textContent()) ?? "").startsWith("closed"));
  expect((await strict.state()).persons).toEqual([]);

  const open = await CovrServer.start('[clients]\nallowed_origins = ["file://", "null"]\n');
  page.searchParams.set("server", open.url.replace("http", "ws"));
  await openPage(page.href);
  await until("the visitor is in the arena", 20_000, async () => (await open.state()).persons.some(({ head_m }) => head_m !== null));
});

const why = withoutPython();
it.skipIf(why !== null)(`lets a visitor in from the Python script${why === null ? "" : ` (skipped: ${why})`}`, async () => {
  const server = await CovrServer.start();
  const script = spawn(PYTHON, [SCRIPT, "--url", server.url.replace("http", "ws"), "--seconds", "4"], { stdio: ["ignore", "pipe", "pipe"] });
  let said = "";
  for (const stream of [script.stdout, script.stderr]) stream.on("data", (chunk: Buffer) => (said += chunk.toString()));
  const ended = new Promise<number | null>((resolve) => script.once("exit", resolve));
  await until("the visitor is tracked", 20_000, async () => (await server.state()).persons.some((person) => person.tracked && person.head_m !== null));
  expect(await ended, said).toBe(0);
  expect(said).toMatch(/column at -?\d/);
  expect(Number(/(\d+) clock_pong/.exec(said)?.[1]), said).toBeGreaterThanOrEqual(3);
  await until("the visitor has left", 5_000, async () => (await server.state()).persons.length === 0);
});

it.skipIf(why !== null)("shows its token in Python, where the server has tokens", async () => {
  const server = await CovrServer.start();
  const token = await server.token("headset", "client");
  await until("the server asks", 10_000, async () => (await fetch(`${server.url}/api/v1/state`)).status === 401);
  const run = (shown: Readonly<Record<string, string>>): ReturnType<typeof spawnSync> =>
    spawnSync(PYTHON, [SCRIPT, "--url", server.url.replace("http", "ws"), "--seconds", "1"], { encoding: "utf8", env: { ...process.env, ...shown } });
  expect(run({}).status).toBe(1);
  const known = run({ COVR_TOKEN: token });
  expect(known.stdout).toContain("welcome from CoVR");
  expect(known.status, `${String(known.stdout)}${String(known.stderr)}`).toBe(0);
});

it.skipIf(why !== null)("says in Python when there is no server", () => {
  const run = spawnSync(PYTHON, [SCRIPT, "--url", "ws://127.0.0.1:9", "--seconds", "1"], { encoding: "utf8" });
  expect(run.status).toBe(1);
  expect(run.stderr).toContain("visitor.py: ws://127.0.0.1:9: ");
});

/** Why the script cannot run here; on CI that is an error. */
function withoutPython(): string | null {
  const run = spawnSync(PYTHON, ["-c", "import websockets"], { encoding: "utf8" });
  if (run.status === 0) return null;
  const reason = run.error === undefined ? `${PYTHON} lacks the package websockets` : `${PYTHON} cannot be run`;
  if (process.env["CI"] !== undefined) throw new Error(`${reason}; tests/setup installs it`);
  return reason;
}
