/** The real server as a child: a free port, a database and a configuration of its own, and its visitors. */
import { execFile, spawn, type ChildProcess } from "node:child_process";
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import { createServer, type AddressInfo } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { promisify } from "node:util";
import { onTestFinished } from "vitest";
import type { Snapshot, WireEvent } from "../../../web/src/api/types";
import { until } from "./until";

/** One server with what it stores. */
export class CovrServer {
  readonly folder: string;
  readonly port: number;
  readonly #config: string;
  #child: ChildProcess | null = null;
  readonly #visitors: ChildProcess[] = [];
  #boards: ChildProcess | null = null;
  #log = "";

  private constructor(folder: string, port: number, config: string) {
    this.folder = folder;
    this.port = port;
    this.#config = config;
  }

  /** Starts one that ends with the test; the configuration is TOML. */
  static async start(config = ""): Promise<CovrServer> {
    const folder = await mkdtemp(join(tmpdir(), "covr-e2e-"));
    const server = new CovrServer(folder, await freePort(), join(folder, "covr.toml"));
    onTestFinished(() => server.#end());
    await writeFile(server.#config, await server.#onMachine(config));
    await server.run();
    return server;
  }

  /** Where it answers. */
  get url(): string {
    return `http://127.0.0.1:${this.port}`;
  }

  /** What it and its visitors said. */
  get log(): string {
    return this.#log;
  }

  /** Runs it, again after a kill on the same port and database. */
  async run(): Promise<void> {
    this.#child = this.#spawn([
      "serve",
      "--config",
      this.#config,
      "--bind",
      `127.0.0.1:${this.port}`,
      "--database",
      join(this.folder, "covr.sqlite"),
    ]);
    await until("the server is ready", 20_000, async () => {
      if (this.#child?.exitCode !== null) throw new Error(`it ended with code ${String(this.#child?.exitCode)}\n${this.#log}`);
      return (await fetch(`${this.url}/readyz`)).ok;
    });
  }

  /** kill -9. */
  async kill(): Promise<void> {
    const child = this.#child;
    if (child === null) return;
    this.#child = null;
    await ended(child, "SIGKILL");
  }

  /** Lets a person in: recorded with a trace, else made up. */
  visitor(...options: string[]): ChildProcess {
    const child = this.#spawn(["visitor", "--url", `ws://127.0.0.1:${this.port}`, ...options]);
    this.#visitors.push(child);
    return child;
  }

  /** Makes a token; from the first one on the server asks everybody. */
  async token(name: string, role: string): Promise<string> {
    const options = ["token", "create", name, "--role", role, "--database", join(this.folder, "covr.sqlite")];
    const { stdout } = await promisify(execFile)(binary(), options);
    return stdout.trim();
  }

  /** `GET /api/v1/state`. */
  async state(): Promise<Snapshot> {
    return (await this.json("GET", "/api/v1/state")) as Snapshot;
  }

  /** `GET /api/v1/events`, newest first. */
  async events(): Promise<readonly WireEvent[]> {
    return (await this.json("GET", "/api/v1/events?limit=1000")) as readonly WireEvent[];
  }

  /** Any call; throws with the answer when it is refused. */
  async json(method: string, path: string, body?: unknown): Promise<unknown> {
    const response = await fetch(this.url + path, {
      method,
      ...(body === undefined ? {} : { body: JSON.stringify(body), headers: { "Content-Type": "application/json" } }),
    });
    const text = await response.text();
    if (!response.ok) throw new Error(`${method} ${path}: ${response.status} ${text}`);
    return JSON.parse(text) as unknown;
  }

  /** Stores a scene and makes it the active one. */
  async useScene(scene: unknown): Promise<number> {
    const { id } = (await this.json("POST", "/api/v1/scenes", scene)) as { id: number };
    await this.json("PUT", `/api/v1/scenes/${id}/activate`, {});
    return id;
  }

  /** The configuration on the machine that is asked for: with COVR_MACHINE=roboclaw or odrive an emulated controller on a pseudo-terminal, whatever is tested. */
  async #onMachine(config: string): Promise<string> {
    const kind = process.env["COVR_MACHINE"];
    if (kind !== "roboclaw" && kind !== "odrive") return config;
    const port = join(this.folder, "boards");
    const travel = /travel_m = \[([^\]]*)\]/.exec(config)?.[1] ?? "0, 0, 4, 4";
    const boards = kind === "roboclaw" ? ["--tuned", "--baud", "460800", "--end-switches", "none"] : [];
    this.#boards = this.#spawn(["emulate", kind, ...boards, "--start", "0.3,0.3", "--travel", travel.replaceAll(" ", ""), "--link", port]);
    await until("the boards are there", 20_000, () => (this.#log.includes(`${kind} emulator on`) ? true : null));
    const line = `kind = "${kind}"\n`;
    const machine = config.includes("[machine]\n") ? config.replace("[machine]\n", `[machine]\n${line}`) : `${config}\n[machine]\n${line}`;
    const stops = kind === "roboclaw" ? 'home_by = "stops"\nswitch_outside_m = 0.03\n' : "";
    return `${machine}\n[machine.${kind}]\nemulated = true\nport = "${port}"\ncurrent_limit_amps = 7.0\n${stops}`;
  }

  async #end(): Promise<void> {
    for (const visitor of this.#visitors) await ended(visitor, "SIGKILL");
    if (this.#child !== null) await ended(this.#child, "SIGTERM");
    if (this.#boards !== null) await ended(this.#boards, "SIGTERM");
    await rm(this.folder, { recursive: true, force: true });
  }

  #spawn(options: string[]): ChildProcess {
    const child = spawn(binary(), options, { cwd: this.folder, stdio: ["ignore", "pipe", "pipe"] });
    for (const stream of [child.stdout, child.stderr]) {
      stream.on("data", (chunk: Buffer) => {
        this.#log = (this.#log + chunk.toString()).slice(-LOG_KEPT);
      });
    }
    return child;
  }
}

/** A port that nobody listens on now. */
export async function freePort(): Promise<number> {
  const server = createServer();
  await new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve));
  const { port } = server.address() as AddressInfo;
  await new Promise((resolve) => server.close(resolve));
  return port;
}

function binary(): string {
  const path = process.env["COVR_BIN"];
  if (path === undefined) throw new Error("COVR_BIN must name the server's binary, covr");
  return path;
}

async function ended(child: ChildProcess, signal: NodeJS.Signals): Promise<void> {
  if (child.exitCode !== null || child.signalCode !== null) return;
  const gone = new Promise<void>((resolve) => child.once("exit", () => { resolve(); }));
  child.kill(signal);
  const tooLong = setTimeout(() => child.kill("SIGKILL"), 10_000);
  await gone;
  clearTimeout(tooLong);
}

const LOG_KEPT = 100_000;
