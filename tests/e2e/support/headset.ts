/** A headset that a test carries from place to place: a VR client in a page of its own, with one person, in a tracking space of its own. */
import type { Page } from "playwright-core";
import { openBrowser } from "./page";

/** A place of the room, m. */
export type Place = readonly [number, number, number];

/** One such headset. */
export class Headset {
  readonly #page: Page;

  private constructor(page: Page) {
    this.#page = page;
  }

  /** Connects one until the test ends. */
  static async connect(url: string, name: string): Promise<Headset> {
    const page = await (await openBrowser()).newPage();
    // Any document of the server will do: its pages may open its sockets.
    await page.goto(`${url}/api/v1/openapi.json`);
    await page.evaluate(wear, name);
    return new Headset(page);
  }

  /** Puts it at a place; carried, it sways about it. */
  async put(at: Place, carried = false): Promise<void> {
    await this.#page.evaluate((place) => { Object.assign(window, { place }); }, { at, carried });
  }

  /** Its person's hand meets an object, or lets go of it. */
  async touch(object: string, began: boolean): Promise<void> {
    await this.#page.evaluate(([id, begins]) => {
      const { say } = window as unknown as { say: (message: unknown) => void };
      say({ type: begins ? "touch_began" : "touch_ended", person: "Ada", object: id, client_time_micros: Math.round(performance.now() * 1000) });
    }, [object, began] as const);
  }
}

/** Where a client without a calibration is taken to be when it is at a place: its tracking space is taken for the room, m. */
export function uncalibrated([x, y, z]: Place): Place {
  const [fromX, fromY] = [x - 2, y - 1];
  const [sin, cos] = [Math.sin(0.5), Math.cos(0.5)];
  return [cos * fromX + sin * fromY, cos * fromY - sin * fromX, z - 0.1];
}

/** In the page: say hello, come in, and send where it is, in OpenXR's axes. */
async function wear(name: string): Promise<void> {
  // Where its tracking space is in the room: turned by this about z, rad, then moved, m.
  const [yaw, originX, originY, originZ] = [0.5, 2, 1, 0.1];
  const kept = window as unknown as { place: { at: readonly [number, number, number]; carried: boolean } };
  kept.place = { at: [1, 1, 1], carried: false };
  const socket = new WebSocket(`ws://${location.host}/ws/v1/client`, "covr.v1.json");
  await new Promise((resolve, reject) => {
    socket.onopen = resolve;
    socket.onerror = reject;
  });
  const say = (message: unknown): void => { socket.send(JSON.stringify(message)); };
  Object.assign(window, { say });
  say({ type: "hello", name, convention: "openxr" });
  say({ type: "enter", person: "Ada" });
  let sequence = 0;
  setInterval(() => {
    sequence += 1;
    const { at, carried } = kept.place;
    const x = at[0] - originX + (carried ? Math.sin(sequence / 20) * 0.1 : 0);
    // Two millimetres of noise, so that residuals are more than zero.
    const [y, z] = [at[1] - originY + 0.002 * Math.sin(sequence * 1.7), at[2] - originZ + 0.002 * Math.sin(sequence * 2.3)];
    const [sin, cos] = [Math.sin(yaw), Math.cos(yaw)];
    say({
      type: "pose",
      person: "Ada",
      sequence,
      client_time_micros: Math.round(performance.now() * 1000),
      position: [sin * x - cos * y, z, -(cos * x + sin * y)],
      orientation: [0, 0, 0, 1],
      tracked: true,
      worn: true,
    });
  }, 11);
}
