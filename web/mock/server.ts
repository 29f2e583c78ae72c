/**
 * A small server with the dashboard's contract: WebSocket, HTTP and problem documents. For development without Rust
 * and for the page's own tests.
 */
import type { IncomingMessage, Server, ServerResponse } from "node:http";
import { WebSocketServer, type WebSocket } from "ws";
import type { FromDashboard, MachineRequest, PriorChange, SceneDocument, SceneError, ToDashboard } from "../src/api/types";
import { MOCK_CONFIG } from "./config.ts";
import { MockMachine, type MockOptions } from "./machine.ts";
import { LINK_THRESHOLDS, MACHINE_SHAPE, MOCK_SCENE } from "./scene.ts";

interface StoredScene {
  readonly id: number;
  readonly version: number;
  readonly author: string;
  readonly changed_at: string;
  readonly document: SceneDocument;
}

/** The mock, to be hung on any HTTP server. */
export class MockServer {
  readonly machine: MockMachine;
  readonly #sockets = new WebSocketServer({ noServer: true });
  readonly #scenes: StoredScene[] = [];
  readonly #changes: PriorChange[] = [];
  readonly #timer: ReturnType<typeof setInterval>;

  constructor(options: MockOptions = { latchedBy: null, mode: "following" }) {
    this.machine = new MockMachine(MOCK_SCENE, options, (event) => {
      this.#broadcast({ type: "event", ...event });
    });
    this.#store(MOCK_SCENE, "mock");
    let steppedMillis = performance.now();
    this.#timer = setInterval(() => {
      // The clock is the wall's: a timer that comes late must not make the state look old.
      const nowMillis = performance.now();
      this.machine.step((nowMillis - steppedMillis) / 1000);
      steppedMillis = nowMillis;
      this.#broadcast({ type: "snapshot", ...this.machine.snapshot() });
    }, STEP_SECS * 1000);
  }

  /** Takes over `/ws/v1/dashboard` of a server. */
  attach(server: Pick<Server, "on">): void {
    server.on("upgrade", (request: IncomingMessage, socket, head: Buffer) => {
      if (request.url !== "/ws/v1/dashboard") return;
      this.#sockets.handleUpgrade(request, socket, head, (client) => {
        this.#greet(client);
      });
    });
  }

  /** Answers a request under `/api/v1`; false if it is for somebody else. */
  handle(request: IncomingMessage, response: ServerResponse): boolean {
    const url = new URL(request.url ?? "/", "http://mock");
    if (!url.pathname.startsWith("/api/v1/")) return false;
    void readBody(request).then((body) => {
      this.#route(request.method ?? "GET", url, body, decodeURIComponent(String(request.headers["x-covr-author"] ?? "")), response);
    });
    return true;
  }

  /** Ends it. */
  close(): void {
    clearInterval(this.#timer);
    for (const client of this.#sockets.clients) client.terminate();
    this.#sockets.close();
  }

  #greet(client: WebSocket): void {
    send(client, { type: "welcome", version: "mock", machine: "simulated", machine_shape: MACHINE_SHAPE, link_thresholds: LINK_THRESHOLDS });
    send(client, this.#sceneMessage());
    client.on("message", (data: Buffer) => {
      const message = JSON.parse(data.toString()) as FromDashboard;
      const reason = message.reason ?? null;
      if (message.type === "stop") {
        const { toDriveMicros } = this.machine.stop(reason);
        send(client, {
          type: "answer",
          request_id: message.request_id,
          outcome: toDriveMicros === null ? "already_so" : "accepted",
          detail: "stopped",
          to_drive_micros: toDriveMicros,
        });
      } else {
        const answer = this.machine.ask(message.request, reason);
        send(client, { type: "answer", request_id: message.request_id, ...answer, to_drive_micros: null });
      }
    });
  }

  #route(method: string, url: URL, body: string, author: string, response: ServerResponse): void {
    const path = url.pathname.slice("/api/v1/".length).split("/");
    const [first, second, third] = path;
    const key = `${method} ${first ?? ""}`;
    if (key === "GET state") reply(response, 200, this.machine.snapshot());
    else if (key === "POST stop") {
      const { toDriveMicros } = this.machine.stop(reasonOf(body));
      reply(response, 200, { acknowledged: true, to_drive_micros: toDriveMicros });
    } else if (method === "POST" && isRequest(first)) {
      const answer = this.machine.ask(first, reasonOf(body));
      if (answer.outcome === "refused") problem(response, 409, "Refused", answer.detail);
      else reply(response, 200, answer);
    } else if (key === "POST persons" && third === "confirm") {
      reply(response, 200, this.machine.ask({ confirm_origin: Number(second) }, null));
    } else if (key === "GET scenes" && second === undefined) {
      reply(
        response,
        200,
        this.#scenes.map(({ document, ...row }) => ({ ...row, name: document.name, active: row.id === this.machine.sceneId })),
      );
    } else if (key === "POST scenes") this.#upload(body, author, response);
    else if (key === "PUT scenes" && third === "activate") this.#activate(Number(second), response);
    else if (key === "GET scenes") {
      const scene = this.#scenes.find((stored) => stored.id === Number(second));
      if (scene === undefined) problem(response, 404, "Not found", `there is no scene ${second ?? ""}`);
      else reply(response, 200, scene.document);
    } else if (key === "PATCH priors") this.#changePriors(body, author, response);
    else if (key === "POST priors" && second === "preview") {
      const found = this.machine.preview(JSON.parse(body) as Record<string, number>);
      if ("unknown" in found) problem(response, 422, "Invalid", `${found.unknown.join(", ")}: expected an object of the active scene`);
      else reply(response, 200, found);
    }
    else if (key === "GET priors") reply(response, 200, this.#changes);
    else if (key === "GET sessions") {
      reply(response, 200, [{ id: 1, started_at: STARTED_AT, ended_at: null, how: null, scene: MOCK_SCENE.name }]);
    } else if (key === "GET config") {
      reply(response, 200, MOCK_CONFIG);
    } else if (key === "GET events") {
this.#events(url, response);
    } else problem(response, 404, "Not found", `nothing is at ${url.pathname}`);
  }

  /** A page of events; rows are counted from the oldest, as a store would. */
  #events(url: URL, response: ServerResponse): void {
    const given = url.searchParams;
    const [kinds, search, person] = [given.get("kind")?.split(","), given.get("search")?.toLowerCase(), given.get("person")];
    const count = this.machine.events.length;
    const before = Number(given.get("before") ?? Infinity);
    const limit = Number(given.get("limit") ?? "100");
    const found = this.machine.events
      .map((event, index) => ({ event, row: count - index }))
      .filter(({ event, row }) => row < before && (kinds?.includes(event.kind) ?? true) && event.summary.toLowerCase().includes(search ?? ""))
      .filter(({ event }) => person === null || (event.detail as { readonly name?: string } | null)?.name === person);
    const page = found.slice(0, limit);
    const last = page.at(-1);
    if (found.length > limit && last !== undefined) {
      given.set("before", String(last.row));
      response.setHeader("Link", `<${url.pathname}?${given.toString()}>; rel="next"`);
    }
    reply(response, 200, page.map(({ event }) => event));
  }

  #upload(body: string, author: string, response: ServerResponse): void {
    const checked = checkScene(body);
    if ("errors" in checked) {
      problem(response, 422, "Scene refused", `${checked.errors.length} finding(s)`, checked.errors);
      return;
    }
    const stored = this.#store(checked.scene, author);
    reply(response, 201, { id: stored.id, version: stored.version });
  }

  #store(document: SceneDocument, author: string): StoredScene {
    const stored = { id: this.#scenes.length + 1, version: 1, author, changed_at: new Date().toISOString(), document };
    this.#scenes.push(stored);
    return stored;
  }

  #activate(id: number, response: ServerResponse): void {
    const scene = this.#scenes.find((stored) => stored.id === id);
    if (scene === undefined) {
      problem(response, 404, "Not found", `there is no scene ${id}`);
      return;
    }
    this.machine.useScene(scene.document);
    this.machine.sceneId = scene.id;
    this.machine.sceneVersion = scene.version;
    this.#broadcast(this.#sceneMessage());
    this.machine.event("scene_activated", `${scene.document.name} is active`);
    reply(response, 200, { id: scene.id, version: scene.version });
  }

  #changePriors(body: string, author: string, response: ServerResponse): void {
    for (const [id, prior] of Object.entries(JSON.parse(body) as Record<string, number>)) {
      const before = this.machine.setPrior(id, prior);
      if (before === null) {
        problem(response, 404, "Not found", `the active scene has no object ${id}`);
        return;
      }
      this.#changes.unshift({ at: new Date().toISOString(), author, object: id, from: before, to: prior });
      this.machine.event("prior_changed", `${author}: ${id} from ${before} to ${prior}`, { author, object: id, from: before, to: prior });
    }
    reply(response, 200, {});
  }

  #sceneMessage(): ToDashboard {
    return { type: "scene", id: this.machine.sceneId, version: this.machine.sceneVersion, scene: this.machine.scene };
  }

  #broadcast(message: ToDashboard): void {
    for (const client of this.#sockets.clients) send(client, message);
  }
}

/** The few checks that the page's own tests need; the real ones are the server's. */
function checkScene(text: string): { scene: SceneDocument } | { errors: SceneError[] } {
  const finding = (path: string, found: string, expected: string): SceneError => ({ path, line: 1, column: 1, found, expected });
  let document: Partial<SceneDocument>;
  try {
    document = JSON.parse(text) as Partial<SceneDocument>;
  } catch (error) {
    return { errors: [finding("$", error instanceof Error ? error.message : "text", "JSON")] };
  }
  const objects = document.objects ?? [];
  if (objects.length === 0) return { errors: [finding("$.objects", "nothing", "at least one object")] };
  const errors = objects.flatMap((object, index) =>
    object.prior < 0 || object.prior > 1 ? [finding(`$.objects[${index}].prior`, String(object.prior), "a number from 0 to 1")] : [],
  );
  return errors.length > 0 ? { errors } : { scene: { ...MOCK_SCENE, ...document } };
}

function isRequest(name: string | undefined): name is Extract<MachineRequest, string> {
  return name === "home" || name === "arm" || name === "disarm" || name === "reset";
}

function reasonOf(body: string): string | null {
  if (body === "") return null;
  const { reason } = JSON.parse(body) as { readonly reason?: string | null };
  return reason === undefined ? null : reason;
}

function send(client: WebSocket, message: ToDashboard): void {
  if (client.readyState === client.OPEN) client.send(JSON.stringify(message));
}

function reply(response: ServerResponse, status: number, body: unknown): void {
  response.writeHead(status, { "Content-Type": "application/json" }).end(JSON.stringify(body));
}

function problem(response: ServerResponse, status: number, title: string, detail: string, errors?: readonly SceneError[]): void {
  response
    .writeHead(status, { "Content-Type": "application/problem+json" })
    .end(JSON.stringify({ type: "about:blank", title, status, detail, errors }));
}

async function readBody(request: IncomingMessage): Promise<string> {
  const chunks: Buffer[] = [];
  for await (const chunk of request) chunks.push(chunk as Buffer);
  return Buffer.concat(chunks).toString("utf8");
}

const STEP_SECS = 1 / 30;
const STARTED_AT = new Date().toISOString();
