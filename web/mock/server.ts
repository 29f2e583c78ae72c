/**
 * A small server with the dashboard's contract: WebSocket, HTTP and problem documents. For development without Rust
 * and for the page's own tests.
 */
import type { IncomingMessage, Server, ServerResponse } from "node:http";
import { WebSocketServer, type WebSocket } from "ws";
import type { FromDashboard, MachineRequest, Me, PriorChange, Reason, SceneDocument, SceneError, ToDashboard } from "../src/api/types";
import { MOCK_CONFIG } from "./config.ts";
import { drawable } from "../src/lib/sceneText.ts";
import { MockMachine, type MockOptions } from "./machine.ts";
import { recordedFrames, sessionDetail, sessionEvents, sessions } from "./session.ts";
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
    this.#store(MOCK_SCENE, "mock", 1);
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
      if (message.type === "jog") {
        const why = message.to === null ? ({ id: "jog_let_go" } as const) : ({ id: "jogs_while_held" } as const);
        send(client, { type: "answer", request_id: message.request_id, outcome: "accepted", detail: why.id, why, to_drive_micros: null });
        return;
      }
      const reason = message.reason ?? null;
      if (message.type === "stop") {
        const { toDriveMicros } = this.machine.stop(reason);
        send(client, {
          type: "answer",
          request_id: message.request_id,
          outcome: toDriveMicros === null ? "already_so" : "accepted",
          detail: "stopped",
          why: { id: "stopped" },
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
    if (key === "GET me") reply(response, 200, UNASKED);
    else if (key === "GET state") reply(response, 200, this.machine.snapshot());
    else if (key === "POST stop") {
      const { toDriveMicros } = this.machine.stop(reasonOf(body));
      reply(response, 200, { acknowledged: true, to_drive_micros: toDriveMicros });
    } else if (method === "POST" && isRequest(first)) {
      const answer = this.machine.ask(first, reasonOf(body));
      if (answer.outcome === "refused") problem(response, 409, "Refused", answer.detail, undefined, answer.why);
      else reply(response, 200, answer);
    } else if (key === "POST persons" && third === "confirm") {
      reply(response, 200, this.machine.ask({ confirm_origin: Number(second) }, null));
    } else if (key === "GET scenes" && second === undefined) {
      reply(
        response,
        200,
        [...new Set(this.#scenes.map(({ id }) => id))].map((id) => {
          const { document, ...row } = this.#newest(id) as StoredScene;
          return { ...row, name: document.name, active: id === this.machine.sceneId };
        }),
      );
    } else if (first === "scenes") this.#scene(method, second, third, url, body, author, response);
    else if (key === "PATCH priors") this.#changePriors(body, author, response);
    else if (key === "POST priors" && second === "preview") {
      const found = this.machine.preview(JSON.parse(body) as Record<string, number>);
      if ("unknown" in found) problem(response, 422, "Invalid", `${found.unknown.join(", ")}: expected an object of the active scene`);
      else reply(response, 200, found);
    } else if (key === "GET priors") reply(response, 200, this.#changes);
    else if (key === "GET sessions") {
      const { searchParams } = url;
      if (second === undefined) {
        const found = sessions(STARTED_AT).filter((row) => row.scene.toLowerCase().includes((searchParams.get("search") ?? "").toLowerCase()));
        reply(response, 200, found.filter((row) => row.id < Number(searchParams.get("before") ?? "Infinity")).slice(0, Number(searchParams.get("limit") ?? "100")));
        return;
      }
      const detail = sessionDetail(Number(second), STARTED_AT);
      const [fromSecs, toSecs, everySecs] = [searchParams.get("from_secs"), searchParams.get("to_secs"), searchParams.get("every_secs")].map(Number) as [number, number, number];
      if (detail === null) problem(response, 404, "Not found", `there is no session ${second}`);
      else if (third === undefined) reply(response, 200, detail);
      else if (third === "events") reply(response, 200, sessionEvents(detail.id));
      else if (third === "frames") reply(response, 200, { frames: detail.id === 2 ? recordedFrames(fromSecs, toSecs, everySecs) : [] });
      else reply(response, 200, detail);
    } else if (key === "GET config") {
      reply(response, 200, MOCK_CONFIG);
    } else if (key === "GET calibrations") {
      // No headset is connected here, so none is ever in the making.
      if (second === "draft") problem(response, 404, "Not found", "no calibration is in the making: begin one first", undefined, { id: "no_calibration_draft" });
      else reply(response, 200, []);
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

  #scene(method: string, second: string | undefined, third: string | undefined, url: URL, body: string, author: string, response: ServerResponse): void {
    const id = Number(second);
    const versions = this.#scenes.filter((stored) => stored.id === id).reverse();
    const asked = url.searchParams.get("version");
    const scene = asked === null ? versions[0] : versions.find(({ version }) => version === Number(asked));
    if (method === "POST") this.#upload(body, author, second === "check" ? null : this.#scenes.length + 1, response);
    else if (scene === undefined) problem(response, 404, "Not found", `there is no scene ${second ?? ""}`);
    else if (third === "activate") this.#activate(scene, response);
    else if (third === "versions") {
      const active = ({ version }: StoredScene): boolean => id === this.machine.sceneId && version === this.machine.sceneVersion;
      reply(response, 200, versions.map((stored) => ({ version: stored.version, author: stored.author, created_at: stored.changed_at, active: active(stored), objects: stored.document.objects.length })));
    } else if (method === "PUT") this.#upload(body, author, id, response);
    else reply(response, 200, scene.document);
  }

  /** Stores under an id, or only checks. */
  #upload(body: string, author: string, id: number | null, response: ServerResponse): void {
    const checked = checkScene(body);
    if ("errors" in checked) {
      problem(response, 422, "Scene refused", `${checked.errors.length} finding(s)`, checked.errors);
    } else if (id === null) reply(response, 200, { valid: true, name: checked.scene.name, objects: checked.scene.objects.length, warnings: [] });
    else {
      const stored = this.#store(checked.scene, author, id);
      reply(response, 201, { id: stored.id, version: stored.version, warnings: [] });
    }
  }

  #store(document: SceneDocument, author: string, id: number): StoredScene {
    const stored = { id, version: (this.#newest(id)?.version ?? 0) + 1, author, changed_at: new Date().toISOString(), document };
    this.#scenes.push(stored);
    return stored;
  }

  #newest(id: number): StoredScene | undefined {
    return this.#scenes.findLast((stored) => stored.id === id);
  }

  #activate(scene: StoredScene, response: ServerResponse): void {
    this.machine.useScene(scene.document);
    this.machine.sceneId = scene.id;
    this.machine.sceneVersion = scene.version;
    this.#broadcast(this.#sceneMessage());
    this.machine.event("scene_activated", `${scene.document.name} is active`);
    reply(response, 200, { id: scene.id, version: scene.version, detail: `${scene.document.name} is active` });
  }

  #changePriors(body: string, author: string, response: ServerResponse): void {
    for (const [id, prior] of Object.entries(JSON.parse(body) as Record<string, number>)) {
      const before = this.machine.setPrior(id, prior);
      if (before === null) {
        problem(response, 404, "Not found", `the active scene has no object ${id}`);
        return;
      }
      const scene = { scene_id: this.machine.sceneId, scene_version: this.machine.sceneVersion };
      this.#changes.unshift({ at: new Date().toISOString(), author, object: id, from: before, to: prior, ...scene });
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

/** The few checks that the page's own tests need, with the line of what they find; the real ones are the server's. */
function checkScene(text: string): { scene: SceneDocument } | { errors: SceneError[] } {
  const finding = (path: string, found: string, expected: string, at = 0): SceneError => {
    const before = text.slice(0, at).split("\n");
    return { path, line: before.length, column: Buffer.byteLength(before.at(-1) ?? "") + 1, found, expected };
  };
  let document: Partial<SceneDocument>;
  try {
    document = JSON.parse(text) as Partial<SceneDocument>;
  } catch (error) {
    return { errors: [finding("$", error instanceof Error ? error.message : "text", "JSON", text.length)] };
  }
  const objects = document.objects ?? [];
  if (objects.length === 0) return { errors: [finding("$.objects", "nothing", "at least one object")] };
  const errors = objects.flatMap((object, index) => {
    if (object.prior >= 0 && object.prior <= 1) return [];
    const at = text.indexOf('"prior"', text.indexOf(JSON.stringify(object.id)));
    return [finding(`$.objects[${index}].prior`, String(object.prior), "a number from 0 to 1", at + text.slice(at).search(/:\s*/) + 2)];
  });
  return errors.length > 0 ? { errors } : { scene: { ...MOCK_SCENE, ...drawable(text) } };
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

function problem(response: ServerResponse, status: number, title: string, detail: string, errors?: readonly SceneError[], why?: Reason | null): void {
  response
    .writeHead(status, { "Content-Type": "application/problem+json" })
    .end(JSON.stringify({ type: "about:blank", title, status, detail, errors, why: why ?? undefined }));
}

async function readBody(request: IncomingMessage): Promise<string> {
  const chunks: Buffer[] = [];
  for await (const chunk of request) chunks.push(chunk as Buffer);
  return Buffer.concat(chunks).toString("utf8");
}

const STEP_SECS = 1 / 30;
const STARTED_AT = new Date().toISOString();

/** A server without tokens asks nobody, and lets everybody do everything that this page asks for. */
const UNASKED: Me = {
  asks: false,
  name: null,
  role: null,
  csrf: null,
  may: ["home", "arm", "disarm", "reset", "stop", "jog"].map((request) => `dashboard ${request}`),
};
