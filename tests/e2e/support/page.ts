/** Any page in a real browser, with what it complains of and whom it asks. */
import { mkdir } from "node:fs/promises";
import { join } from "node:path";
import { chromium, type Browser, type Page } from "playwright-core";
import { onTestFinished } from "vitest";

/** One open page. */
export interface OpenPage {
  readonly page: Page;
  /** Errors, warnings and refusals by the page's policy. */
  readonly complaints: string[];
  /** The origins that it asked for anything but data in the page itself. */
  readonly asked: Set<string>;
}

/** A browser until the test ends. */
export async function openBrowser(): Promise<Browser> {
  const browser = await chromium.launch({
    executablePath: join(import.meta.dirname, "browser"),
    args: [
      "--no-sandbox",
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
    ],
  });
  onTestFinished(() => browser.close());
  return browser;
}

/** Opens an address until the test ends. */
export async function openPage(url: string): Promise<OpenPage> {
  const browser = await openBrowser();
  const page = await browser.newPage({ viewport: { width: 1366, height: 768 } });
  const complaints: string[] = [];
  const asked = new Set<string>();
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error" || message.type() === "warning") complaints.push(message.text());
  });
  page.on("request", (request) => {
    if (/^(https?|wss?):/.test(request.url())) asked.add(new URL(request.url()).origin);
  });
  await page.goto(url);
  return { page, complaints, asked };
}

/** Keeps a picture in `out`. */
export async function picture(page: Page, name: string): Promise<void> {
  const folder = join(import.meta.dirname, "../out");
  await mkdir(folder, { recursive: true });
  await page.screenshot({ path: join(folder, `${name}.png`) });
}
