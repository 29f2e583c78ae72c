/**
 * The server over HTTP: everything that the socket does not carry, and the stop's second lane. Each call has a
 * deadline; a refusal is a `Problem` with the server's own words.
 */
import type {
  Calibration,
  CalibrationDraft,
  CalibrationSummary,
  CalibrationTask,
  ChecklistNow,
  Commissioning,
  ConfigInForce,
  Me,
  NewCalibrationPoint,
  Phrase,
  PriorChange,
  PriorPreview,
  ProblemDocument,
  Reason,
  RecordedFrame,
  SceneChecked,
  SceneDocument,
  SceneError,
  SceneStored,
  SceneSummary,
  SceneVersionSummary,
  Session,
  SessionDetail,
  StopAcknowledged,
  WireEvent,
} from "./types";
import { isReason } from "./reason";

/** A refusal, as RFC 9457 has it. */
export class Problem extends Error {
  readonly status: number;
  /** What ends its type: `refused`, `not-found`; empty where the answer was no problem document. */
  readonly kind: string;
  readonly title: string;
  /** The detail as an id and its values, where it is one of the known reasons. */
  readonly why: Reason | null;
  /** The detail as a phrase, where it is one of the known ones. */
  readonly detailAs: Phrase | null;
  readonly errors: readonly SceneError[];

  constructor(status: number, kind: string, title: string, detail: string, why: Reason | null, detailAs: Phrase | null, errors: readonly SceneError[]) {
    super(detail);
    this.name = "Problem";
    this.status = status;
    this.kind = kind;
    this.title = title;
    this.why = why;
    this.detailAs = detailAs;
    this.errors = errors;
  }
}

/** The server was not reached. */
export class Unreachable extends Error {
  constructor(cause: unknown) {
    super("the server was not reached", { cause });
    this.name = "Unreachable";
  }
}

/** The server did not answer in time. */
export class Unanswered extends Error {
  /** The deadline, s. */
  readonly secs: number;

  constructor(secs: number) {
    super(`no answer within ${secs} s`);
    this.name = "Unanswered";
    this.secs = secs;
  }
}

/** `POST /api/v1/stop`. */
export async function postStop(
  reason: string | null,
  giveUp: AbortSignal,
): Promise<{ acknowledged: boolean; to_drive_micros: number | null }> {
  const response = await reach("/api/v1/stop", {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ reason }),
    signal: giveUp,
    cache: "no-store",
  });
  if (!response.ok) throw await problemOf(response);
  const body: Partial<Record<keyof StopAcknowledged, unknown>> = record(await response.json());
  return {
    acknowledged: body.acknowledged === true,
    to_drive_micros: typeof body.to_drive_micros === "number" ? body.to_drive_micros : null,
  };
}

/** `GET /api/v1/me`: whom the server takes this page for. */
export async function readMe(): Promise<Me> {
  return remembered((await call("GET", "/api/v1/me")) as Me);
}

/** `POST /api/v1/login`. */
export async function signIn(token: string): Promise<Me> {
  return remembered((await call("POST", "/api/v1/login", { text: JSON.stringify({ token }), author: "" })) as Me);
}

/** `POST /api/v1/logout`. */
export async function signOut(): Promise<Me> {
  return remembered((await call("POST", "/api/v1/logout", { text: "", author: "" })) as Me);
}

/** `GET /api/v1/scenes`. */
export async function listScenes(): Promise<readonly SceneSummary[]> {
  return (await call("GET", "/api/v1/scenes")) as readonly SceneSummary[];
}

/** `POST /api/v1/scenes`: the document as it was written, so that lines and columns in errors are the author's. */
export async function uploadScene(text: string, author: string): Promise<SceneStored> {
  return (await call("POST", "/api/v1/scenes", { text, author })) as SceneStored;
}

/** `PUT /api/v1/scenes/{id}`: a new version of a scene. */
export async function replaceScene(id: number, text: string, author: string): Promise<SceneStored> {
  return (await call("PUT", `/api/v1/scenes/${id}`, { text, author })) as SceneStored;
}

export type { SceneChecked };

/** `POST /api/v1/scenes/check`: whether the server would store it. */
export async function checkScene(text: string, author: string): Promise<SceneChecked> {
  return (await call("POST", "/api/v1/scenes/check", { text, author })) as SceneChecked;
}

/** `GET /api/v1/scenes/{id}`: a version, the newest when none is named. */
export async function readScene(id: number, version?: number): Promise<SceneDocument> {
  return (await call("GET", `/api/v1/scenes/${id}${version === undefined ? "" : `?version=${version}`}`)) as SceneDocument;
}

/** `GET /api/v1/scenes/{id}/versions`, newest first. */
export async function listSceneVersions(id: number): Promise<readonly SceneVersionSummary[]> {
  return (await call("GET", `/api/v1/scenes/${id}/versions`)) as readonly SceneVersionSummary[];
}

/** `PUT /api/v1/scenes/{id}/activate`; what it did, in the server's words. */
export async function activateScene(id: number, version: number, author: string): Promise<void> {
  await call("PUT", `/api/v1/scenes/${id}/activate?version=${version}`, { text: "{}", author });
}

/** `PATCH /api/v1/priors`. */
export async function changePriors(priors: Readonly<Record<string, number>>, author: string): Promise<void> {
  await call("PATCH", "/api/v1/priors", { text: JSON.stringify(priors), author });
}

/** `POST /api/v1/priors/preview`: what such priors would lead to; changes nothing. */
export async function previewPriors(priors: Readonly<Record<string, number>>, giveUp: AbortSignal): Promise<PriorPreview> {
  return (await call("POST", "/api/v1/priors/preview", { text: JSON.stringify(priors), author: "" }, giveUp)) as PriorPreview;
}

/** `GET /api/v1/priors/changes`, newest first. */
export async function listPriorChanges(): Promise<readonly PriorChange[]> {
  return (await call("GET", "/api/v1/priors/changes")) as readonly PriorChange[];
}

/** `GET /api/v1/sessions`, newest first: those that a search finds, older than one. */
export async function listSessions(asked: { search: string; before: number | null; limit: number }): Promise<readonly Session[]> {
  const query = new URLSearchParams({ limit: String(asked.limit) });
  if (asked.search !== "") query.set("search", asked.search);
  if (asked.before !== null) query.set("before", String(asked.before));
  return (await call("GET", `/api/v1/sessions?${query.toString()}`)) as readonly Session[];
}

/** `GET /api/v1/sessions/{id}`. */
export async function readSession(id: number): Promise<SessionDetail> {
  return (await call("GET", `/api/v1/sessions/${id}`)) as SessionDetail;
}

/** `GET /api/v1/sessions/{id}/frames`: those of a stretch, s from the session's start, oldest first. */
export async function readFrames(
  id: number,
  fromSecs: number,
  toSecs: number,
  everySecs: number,
  giveUp: AbortSignal,
): Promise<readonly RecordedFrame[]> {
  const query = new URLSearchParams({ from_secs: fromSecs.toFixed(3), to_secs: toSecs.toFixed(3) });
  if (everySecs > 0) query.set("every_secs", String(everySecs));
  const answer = record(await call("GET", `/api/v1/sessions/${id}/frames?${query.toString()}`, undefined, giveUp));
  return answer["frames"] as readonly RecordedFrame[];
}

/** `GET /api/v1/sessions/{id}/events`, oldest first. */
export async function listSessionEvents(id: number): Promise<readonly WireEvent[]> {
  return (await call("GET", `/api/v1/sessions/${id}/events`)) as readonly WireEvent[];
}

/** Where a session is exported. */
export function exportAddress(id: number, format: "csv" | "json"): string {
  return `/api/v1/sessions/${id}/export?format=${format}`;
}

/** `GET /api/v1/events`, newest first. */
export async function listEvents(limit: number): Promise<readonly WireEvent[]> {
  return (await call("GET", `/api/v1/events?limit=${limit}`)) as readonly WireEvent[];
}

/** `GET /api/v1/commissionings`, newest first. */
export async function listCommissionings(): Promise<readonly Commissioning[]> {
  return (await call("GET", "/api/v1/commissionings")) as readonly Commissioning[];
}

/** `GET /api/v1/calibrations`, newest first. */
export async function listCalibrations(): Promise<readonly CalibrationSummary[]> {
  return (await call("GET", "/api/v1/calibrations")) as readonly CalibrationSummary[];
}

/** `GET /api/v1/calibrations/draft`; null while none is in the making. */
export async function readCalibrationDraft(): Promise<CalibrationDraft | null> {
  try {
    return (await call("GET", "/api/v1/calibrations/draft")) as CalibrationDraft;
  } catch (error) {
    if (error instanceof Problem && error.why?.id === "no_calibration_draft") return null;
    throw error;
  }
}

/** `PUT /api/v1/calibrations/draft`. */
export async function beginCalibration(task: CalibrationTask, author: string): Promise<CalibrationDraft> {
  return (await call("PUT", "/api/v1/calibrations/draft", { text: JSON.stringify(task), author })) as CalibrationDraft;
}

/** `POST /api/v1/calibrations/draft/points`: measured for a second. */
export async function takeCalibrationPoint(point: NewCalibrationPoint, author: string): Promise<CalibrationDraft> {
  return (await call("POST", "/api/v1/calibrations/draft/points", { text: JSON.stringify(point), author })) as CalibrationDraft;
}

/** `DELETE /api/v1/calibrations/draft/points/{number}`. */
export async function removeCalibrationPoint(number: number, author: string): Promise<CalibrationDraft> {
  return (await call("DELETE", `/api/v1/calibrations/draft/points/${number}`, { text: "", author })) as CalibrationDraft;
}

/** `DELETE /api/v1/calibrations/draft`. */
export async function discardCalibration(author: string): Promise<void> {
  await call("DELETE", "/api/v1/calibrations/draft", { text: "", author });
}

/** `POST /api/v1/calibrations`: stores the one in the making and puts it in force. */
export async function acceptCalibration(author: string): Promise<Calibration> {
  return (await call("POST", "/api/v1/calibrations", { text: "", author })) as Calibration;
}

/** `PUT /api/v1/calibrations/{id}/activate` or `/retire`. */
export async function chooseCalibration(id: number, inForce: boolean, author: string): Promise<void> {
  await call("PUT", `/api/v1/calibrations/${id}/${inForce ? "activate" : "retire"}`, { text: "", author });
}

/** `POST /api/v1/calibrations/{id}/scene`: a prop's calibration as a new version of the active scene. */
export async function writeCalibrationIntoScene(id: number, author: string): Promise<SceneStored> {
  return (await call("POST", `/api/v1/calibrations/${id}/scene`, { text: "", author })) as SceneStored;
}

/** `POST /api/v1/notes`: a note in the record, of the running session. */
export async function addNote(text: string, author: string): Promise<void> {
  await call("POST", "/api/v1/notes", { text: JSON.stringify({ text }), author });
}

/** `GET /api/v1/checklist`. */
export async function readChecklist(): Promise<ChecklistNow> {
  return (await call("GET", "/api/v1/checklist")) as ChecklistNow;
}

/** `PUT /api/v1/checklist/{item}`. */
export async function tickItem(item: number, ticked: boolean, author: string): Promise<ChecklistNow> {
  return (await call("PUT", `/api/v1/checklist/${item}`, { text: JSON.stringify({ ticked }), author })) as ChecklistNow;
}

/** `GET /api/v1/config`. */
export async function readConfig(): Promise<ConfigInForce> {
  return (await call("GET", "/api/v1/config")) as ConfigInForce;
}

/** Which events are asked for; what is not given does not restrict. */
export interface EventQuery {
  readonly kinds: readonly string[] | null;
  readonly session: number | null;
  readonly search: string;
  readonly person: string | null;
}

/** Some events, newest first, and where older ones are; null when these were the last. */
export interface EventPage {
  readonly events: readonly WireEvent[];
  readonly next: string | null;
}

/** `GET /api/v1/events`, a page of those that a query lets through, or the page that an earlier one named. */
export async function readEvents(query: EventQuery | string, giveUp: AbortSignal): Promise<EventPage> {
  const response = await ask("GET", typeof query === "string" ? query : `/api/v1/events?${parametersOf(query)}`, undefined, giveUp);
  const next = /<([^>]+)>; rel="next"/.exec(response.headers.get("Link") ?? "")?.[1];
  return { events: (await response.json()) as readonly WireEvent[], next: next ?? null };
}

function parametersOf({ kinds, session, search, person }: EventQuery): string {
  const parameters = new URLSearchParams({ limit: String(EVENTS_A_PAGE) });
  if (kinds !== null) parameters.set("kind", kinds.join(","));
  if (session !== null) parameters.set("session", String(session));
  if (search !== "") parameters.set("search", search);
  if (person !== null) parameters.set("person", person);
  return parameters.toString();
}

/** The server's proof goes out with everything that changes something; the stop needs none. */
function remembered(me: Me): Me {
  proof = me.csrf;
  return me;
}

let proof: string | null = null;

async function call(method: string, path: string, body?: Body, giveUp?: AbortSignal): Promise<unknown> {
  const text = await (await ask(method, path, body, giveUp)).text();
  return text === "" ? null : (JSON.parse(text) as unknown);
}

/** What is sent, and by whom; nobody's name is left out. */
interface Body {
  readonly text: string;
  readonly author: string;
}

async function ask(method: string, path: string, body?: Body, giveUp?: AbortSignal): Promise<Response> {
  const deadline = AbortSignal.timeout(CALL_DEADLINE_MILLIS);
  const author = body === undefined || body.author === "" ? {} : { "X-Covr-Author": encodeURIComponent(body.author) };
  const response = await reach(path, {
    method,
    cache: "no-store",
    signal: giveUp === undefined ? deadline : AbortSignal.any([deadline, giveUp]),
    ...(body === undefined
      ? {}
      : { body: body.text, headers: { "Content-Type": "application/json", ...author, ...(proof === null ? {} : { "X-Covr-Csrf": proof }) } }),
  });
  if (!response.ok) throw await problemOf(response);
  return response;
}

/** The answer of the server, or the error that tells why there is none. */
async function reach(path: string, init: RequestInit): Promise<Response> {
  try {
    return await fetch(path, init);
  } catch (error) {
    if (error instanceof DOMException && error.name === "TimeoutError") throw new Unanswered(CALL_DEADLINE_MILLIS / 1000);
    throw error instanceof TypeError ? new Unreachable(error) : error;
  }
}

async function problemOf(response: Response): Promise<Problem> {
  const fallback = `${response.status} ${response.statusText}`.trim();
  let body: Partial<Record<keyof ProblemDocument, unknown>>;
  try {
    body = record(await response.json());
  } catch {
    return new Problem(response.status, "", fallback, fallback, null, null, []);
  }
  const title = typeof body.title === "string" ? body.title : fallback;
  const detail = typeof body.detail === "string" ? body.detail : title;
  const errors = Array.isArray(body.errors) ? body.errors.map(sceneErrorOf) : [];
  const kind = typeof body.type === "string" ? (body.type.split(":").at(-1) ?? "") : "";
  return new Problem(response.status, kind, title, detail, isReason(body.why) ? body.why : null, phraseOf(body["detail_as" as keyof typeof body]) ?? null, errors);
}

function sceneErrorOf(value: unknown): SceneError {
  const body = record(value);
  const text = (field: string): string => {
    const found = body[field];
    return typeof found === "string" ? found : found === undefined ? "" : JSON.stringify(found);
  };
  const whole = (field: string): number | null => {
    const found = body[field];
    return typeof found === "number" ? found : null;
  };
  return {
    path: text("path"),
    line: whole("line"),
    column: whole("column"),
    found: text("found"),
    expected: text("expected"),
    ...optional("found_as", phraseOf(body["found_as"])),
    ...optional("expected_as", phraseOf(body["expected_as"])),
  };
}

function optional<Key extends string>(key: Key, phrase: Phrase | undefined): { readonly [K in Key]?: Phrase } {
  return phrase === undefined ? {} : ({ [key]: phrase } as { readonly [K in Key]: Phrase });
}

function phraseOf(value: unknown): Phrase | undefined {
  const { id, values } = record(value);
  if (typeof id !== "string") return undefined;
  const texts = Object.entries(record(values)).map(([name, found]) => [name, String(found)] as const);
  return { id, values: Object.fromEntries(texts) };
}

function record(value: unknown): Record<string, unknown> {
  return typeof value === "object" && value !== null ? (value as Record<string, unknown>) : {};
}

const CALL_DEADLINE_MILLIS = 5000;
const EVENTS_A_PAGE = 100;
