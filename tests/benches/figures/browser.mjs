// Drives a browser for the benchmark: node browser.mjs URL VIEWS SECONDS. Prints one JSON object.
import { createRequire } from "node:module";

const { chromium } = createRequire(new URL("../../e2e/package.json", import.meta.url))("playwright-core");
const [url, views, seconds] = [process.argv[2], Number(process.argv[3]), Number(process.argv[4])];

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: [
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
  ],
});

// A context of its own has an empty cache. The page says "live" when it shows a snapshot.
async function open() {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
  const page = await context.newPage();
  const began = performance.now();
  await page.goto(url, { waitUntil: "commit" });
  // A state is live by what the page says of itself, whatever its language.
  await page.waitForFunction(() => document.querySelector('[data-testid="mode"]')?.getAttribute("data-mode"), null, {
    timeout: 20_000,
    polling: "raf",
  });
  return { page, context, millis: performance.now() - began };
}

const firstViews = [];
(await open()).context.close();
for (let view = 0; view < views; view += 1) {
  const { context, millis } = await open();
  firstViews.push(millis);
  await context.close();
}

const { page, context } = await open();
const cdp = await context.newCDPSession(page);
await cdp.send("Performance.enable");
await page.waitForTimeout(2_000);
const measured = async () => Object.fromEntries((await cdp.send("Performance.getMetrics")).metrics.map(({ name, value }) => [name, value]));
const before = await measured();
const { frames, secs } = await page.evaluate(
  (length) =>
    new Promise((resolve) => {
      let frames = 0;
      let first = null;
      const frame = (at) => {
        first ??= at;
        if (at - first >= length * 1_000) resolve({ frames, secs: (at - first) / 1_000 });
        else {
          frames += 1;
          requestAnimationFrame(frame);
        }
      };
      requestAnimationFrame(frame);
    }),
  seconds,
);
const after = await measured();
const renderer = await page.evaluate(() => {
  const gl = document.createElement("canvas").getContext("webgl");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  return info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : "software, without WebGL";
});
await browser.close();

const perFrame = (name) => (1_000 * (after[name] - before[name])) / frames;
process.stdout.write(
  JSON.stringify({
    first_views_millis: firstViews,
    frames_per_sec: frames / secs,
    script_millis_per_frame: perFrame("ScriptDuration"),
    main_thread_millis_per_frame: perFrame("TaskDuration"),
    renderer,
  }),
);
