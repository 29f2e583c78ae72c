/** The dashboard in a real browser, and what its own socket receives. */
import type { Page } from "playwright-core";
import type { Mode, Snapshot, ToDashboard, WireEvent } from "../../../web/src/api/types";
import { openBrowser, picture } from "./page";
import { until } from "./until";

/** One open page. */
export class Dashboard {
  readonly page: Page;
  /** Every snapshot that the page's socket received. */
  readonly snapshots: Snapshot[] = [];
  /** Every event that it received, oldest first. */
  readonly events: WireEvent[] = [];
  /** What the page complained of. */
  readonly complaints: string[] = [];

  private constructor(page: Page) {
    this.page = page;
    page.on("pageerror", (error) => this.complaints.push(error.message));
    page.on("websocket", (socket) => {
      socket.on("framereceived", ({ payload }) => {
        this.#take(JSON.parse(payload.toString()) as ToDashboard);
      });
    });
  }

  /** Opens the page, until the test ends, and waits until it is live. The tour comes at a first visit alone. */
  static async open(url: string, scheme: "dark" | "light" = "dark", firstVisit = false): Promise<Dashboard> {
    const browser = await openBrowser();
    const page = await browser.newPage({ viewport: { width: 1366, height: 768 }, colorScheme: scheme });
    const dashboard = new Dashboard(page);
    if (!firstVisit) await page.addInitScript(tourWasSeen);
    await page.goto(url);
    await dashboard.isLive();
    return dashboard;
  }

  /** The newest snapshot. */
  get now(): Snapshot {
    const newest = this.snapshots.at(-1);
    if (newest === undefined) throw new Error("the page has received no snapshot yet");
    return newest;
  }

  /** What an element says. */
  async says(testId: string): Promise<string> {
    return (await this.page.getByTestId(testId).textContent()) ?? "";
  }

  /** Waits until the page calls its state live. */
  async isLive(deadlineMillis = 15_000): Promise<void> {
    await until("the page is live", deadlineMillis, async () => (await this.says("link")) === "live");
  }

  /** Waits until the page shows a mode. */
  async shows(mode: Mode, deadlineMillis = 20_000): Promise<void> {
    await until(`the page shows ${mode}`, deadlineMillis, async () => {
      return (await this.page.getByTestId("mode").getAttribute("data-mode", { timeout: 500 })) === mode;
    });
  }

  /** Homes and arms with the page's buttons. */
  async homeAndArm(): Promise<void> {
    await this.page.getByTestId("home").click();
    await this.shows("ready", 60_000);
    await this.page.getByTestId("arm").click();
    await until("the machine is armed", 10_000, () => this.now.mode === "following" || this.now.mode === "protective_stop");
  }

  /** Waits until the column moves faster than this. */
  async moves(speedMps: number, deadlineMillis = 60_000): Promise<void> {
    await until(`the column moves at ${speedMps} m/s`, deadlineMillis, () => speedOf(this.now) > speedMps);
  }

  /** Waits until the column rests, and then checks that it rests for so many snapshots more. */
  async rests(snapshots: number): Promise<void> {
    await until("the column rests", 5_000, () => speedOf(this.now) < REST_MPS);
    const from = this.snapshots.length;
    await until("more snapshots come", 20_000, () => this.snapshots.length >= from + snapshots);
    const moving = this.snapshots.slice(from).find((snapshot) => speedOf(snapshot) >= REST_MPS);
    if (moving !== undefined) throw new Error(`the column moved again, at ${speedOf(moving)} m/s`);
  }

  /** Keeps a picture in `out`. */
  async picture(name: string): Promise<void> {
    await picture(this.page, name);
  }

  #take(message: ToDashboard): void {
    if (message.type === "snapshot") this.snapshots.push(message);
    if (message.type === "event") this.events.push(message);
  }
}

/** In the page: whoever sits there has been shown around. */
function tourWasSeen(): void {
  const key = `covr.preferences.${localStorage.getItem("covr.author") ?? "game master"}`;
  const kept = JSON.parse(localStorage.getItem(key) ?? "{}") as object;
  localStorage.setItem(key, JSON.stringify({ ...kept, tourDone: true }));
}

/** The column's measured speed, m/s. */
export function speedOf(snapshot: Snapshot): number {
  return Math.hypot(...snapshot.column.velocity_mps);
}

/** How far the column's measured centre is from a place on the floor, m. */
export function distanceTo(snapshot: Snapshot, place: readonly [number, number]): number {
  const [x, y] = snapshot.column.position_m;
  return Math.hypot(x - place[0], y - place[1]);
}

/** Encoders are coarse: slower than this is rest, m/s. */
const REST_MPS = 0.01;
