// @vitest-environment happy-dom
import { cleanup, fireEvent, render, screen } from "@solidjs/testing-library";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { MOCK_SCENE } from "../../mock/scene";
import * as http from "../api/http";
import type { Client, WireEvent } from "../api/types";
import { useLanguage } from "../i18n";
import { LinkQuality } from "./LinkQuality";
import { linesOf } from "./Sparkline";
import { testLive } from "./testLive";
import { Timeline } from "./Timeline";
import { Weights } from "./Weights";
import { stripWords } from "./WeightStrip";

vi.mock("../api/http", { spy: true });
// happy-dom measures nothing.
vi.stubGlobal("ResizeObserver", class { observe(): void { /* no size */ } disconnect(): void { /* nothing held */ } });

beforeEach(() => {
  vi.mocked(http.readEvents).mockImplementation(() => Promise.resolve({ events: [], next: null }));
});
afterEach(() => {
  cleanup();
  useLanguage("en");
  vi.clearAllMocks();
});

describe("weights", () => {
  it("show every object in the scene's order, and the one committed to", () => {
    const { live, show, machine } = testLive();
    show(0.1);
    render(() => <Weights live={live} />);
    const rows = screen.getByTestId("weights").children;
    expect([...rows].map((row) => row.getAttribute("data-testid"))).toEqual(MOCK_SCENE.objects.map(({ id }) => `object-${id}`));
    const committed = machine.snapshot().column.committed ?? "";
    expect(screen.getByTestId(`object-${committed}`).textContent).toContain("the column is committed to it");
    expect(screen.getByTestId("object-curtain").textContent).toContain("off in this scene");
  });

  it("find objects by name, and leave out what weighed little all minute long", () => {
    const { live, show } = testLive();
    render(() => <Weights live={live} />);
    show(0.1, (snapshot) => ({ ...snapshot, objects: snapshot.objects.map((object) => ({ ...object, weight: object.id === "rock" ? 0.4 : 0.05 })) }));
    show(1, (snapshot) => ({ ...snapshot, objects: snapshot.objects.map((object) => ({ ...object, weight: object.id === "lever" ? 0.4 : 0.05 })) }));
    fireEvent.click(screen.getByTestId("weights-heavy"));
    expect([...screen.getByTestId("weights").children].map((row) => row.getAttribute("data-testid"))).toEqual(["object-lever", "object-rock"]);
    fireEvent.input(screen.getByTestId("weights-search"), { target: { value: "ROC" } });
    expect(screen.getByTestId("weights-shown").textContent).toBe("1 of 6 objects");
    fireEvent.input(screen.getByTestId("weights-search"), { target: { value: "nothing of that name" } });
    expect(screen.queryByTestId("weights")).toBeNull();
  });

  it("show two hundred objects", () => {
    const object = MOCK_SCENE.objects[0];
    if (object === undefined) throw new Error("the mock's scene has objects");
    const { live, show } = testLive({ ...MOCK_SCENE, objects: Array.from({ length: 200 }, (_, index) => ({ ...object, id: `o${index}`, label: `Object ${index}` })) });
    show(0.1);
    render(() => <Weights live={live} />);
    expect(screen.getByTestId("weights").children).toHaveLength(200);
  });

  it("say a strip in words, gaps named as gaps", () => {
    const bars = [null, null, { weight: 0.1, committed: false }, { weight: 0.6, committed: true }];
    expect(stripWords(bars, [3])).toBe("Weight over the last minute: 0.10 to 0.60; committed for 15 s; nothing known for 30 s; served once");
    expect(stripWords([null, null], [])).toBe("Nothing known over the last minute");
  });
});

describe("the timeline", () => {
  const past: readonly WireEvent[] = Array.from({ length: 3 }, (_, index) => ({
    at_micros: 0,
    at: new Date(Date.now() - (index + 1) * 60_000).toISOString(),
    kind: index === 1 ? "stop_pressed" : "scene_event",
    summary: `past ${index}`,
    detail: index === 1 ? { author: "Bo", to_drive_micros: 900 } : { name: `bell ${index}` },
  }));
  const listed = (): number => screen.queryAllByTestId("events").flatMap((list) => [...list.querySelectorAll("button.event")]).length;

  it("follows what happens, asks the server by the filters, and goes further back by its pages", async () => {
    vi.mocked(http.readEvents).mockImplementation((query) =>
      Promise.resolve(query === "/older" ? { events: past.slice(2), next: null } : { events: past.slice(0, 2), next: "/older" }),
    );
    const { live, show, machine } = testLive();
    show(0.1);
    render(() => <Timeline live={live} />);
    await vi.waitFor(() => {
      expect(listed()).toBe(2);
    });
    machine.event("person_entered", "Ada entered", { person: 1, name: "Ada" });
    expect(screen.getByTestId("events").textContent).toContain("Ada entered");
    fireEvent.click(screen.getByTestId("timeline-older"));
    await vi.waitFor(() => {
      expect(listed()).toBe(4);
    });
    expect(screen.queryByTestId("timeline-older")).toBeNull();
    fireEvent.click(screen.getByTestId("timeline-group-people"));
    expect(listed()).toBe(1);
    await vi.waitFor(() => {
      expect(vi.mocked(http.readEvents).mock.lastCall?.[0]).toMatchObject({ kinds: ["person_entered", "person_left", "served", "origin_changed", "touch_began", "touch_ended", "interaction_began", "interaction_ended", "contact_over"] });
    });
  });

  it("stands still while it is paused, and counts what it keeps back", () => {
    const { live, show, machine } = testLive();
    show(0.1);
    machine.event("scene_event", "one", { name: "one" });
    render(() => <Timeline live={live} />);
    fireEvent.click(screen.getByTestId("timeline-pause"));
    machine.event("scene_event", "two", { name: "two" });
    expect(listed()).toBe(1);
    fireEvent.click(screen.getByTestId("timeline-pause"));
    expect(listed()).toBe(2);
  });

  it("shows the particulars of an event chosen on the bar, reached by arrow keys", async () => {
    vi.mocked(http.readEvents).mockImplementation(() => Promise.resolve({ events: past, next: null }));
    const { live, show } = testLive();
    show(0.1);
    render(() => <Timeline live={live} />);
    await vi.waitFor(() => {
      expect(screen.getByTestId("time-bar").querySelectorAll("button")).toHaveLength(3);
    });
    const reached = (): (string | null)[] => [...screen.getByTestId("time-bar").querySelectorAll('button[tabindex="0"]')].map((mark) => mark.getAttribute("data-kind"));
    expect(reached()).toEqual(["scene_event"]);
    fireEvent.keyDown(screen.getByTestId("time-bar"), { key: "ArrowLeft" });
    expect(reached()).toEqual(["stop_pressed"]);
    const mark = screen.getByTestId("time-bar").querySelector<HTMLElement>('button[tabindex="0"]');
    if (mark === null) throw new Error("one mark is reached");
    fireEvent.click(mark);
    expect(screen.getByTestId("event-details").textContent).toContain("To the drive0.9 ms");
    fireEvent.click(screen.getByTestId("event-details-close"));
    expect(screen.queryByTestId("event-details")).toBeNull();
  });

  it("says why events could not be read", async () => {
    vi.mocked(http.readEvents).mockRejectedValue(new Error("the store does not answer"));
    const { live } = testLive();
    render(() => <Timeline live={live} />);
    await vi.waitFor(() => {
      expect(screen.getByTestId("timeline-trouble").textContent).toBe("Events could not be read: the store does not answer");
    });
  });
});

describe("links", () => {
  const client = (name: string, change: Partial<Client>): Client => ({ name, convention: "unity", poses: 1, pose_rate_hz: 72, rtt_millis: 2, persons: [1], pose_age_millis: 10, jitter_millis: 1, loss_percent: 0, errors: 0, ...change });

  it("show each client with its state in a word and a shape", () => {
    const { live, show } = testLive();
    show(0.1, (snapshot) => ({ ...snapshot, clients: [client("quest", {}), client("quest", { loss_percent: 6, pose_age_millis: 60, rtt_millis: null })] }));
    render(() => <LinkQuality live={live} />);
    expect(screen.getByTestId("link-quest").dataset["grade"]).toBe("good");
    expect(screen.getByTestId("link-quest 2").dataset["grade"]).toBe("bad");
    expect(screen.getByTestId("link-quest 2-loss_percent").textContent).toContain("■ bad");
    expect(screen.getByTestId("link-quest 2-pose_age_millis").textContent).toContain("▲ weak");
    expect(screen.getByTestId("link-quest 2-rtt_millis").textContent).toContain("○ not measured");
    expect(screen.getByTestId("link-quest").textContent).toContain("unity, for Ada");
    useLanguage("fr");
    expect(screen.getByTestId("link-quest 2-loss_percent").textContent).toContain("■ mauvais");
  });

  it("follow refused messages while the page looks, and say how to connect when nobody is", () => {
    const { live, show } = testLive();
    render(() => <LinkQuality live={live} />);
    show(0.1, (snapshot) => ({ ...snapshot, clients: [client("quest", { errors: 4 })] }));
    expect(screen.getByTestId("link-quest-errors").textContent).toContain("● good");
    show(1, (snapshot) => ({ ...snapshot, clients: [client("quest", { errors: 6 })] }));
    expect(screen.getByTestId("link-quest-errors").textContent).toContain("6, 2 in the last minute");
    show(1, (snapshot) => ({ ...snapshot, clients: [] }));
    expect(screen.getByTestId("links-empty").textContent).toContain("/ws/v1/client");
  });

  it("call the page's own link bad when it is stale", () => {
    const { live, show, setFreshness } = testLive();
    show(0.1);
    render(() => <LinkQuality live={live} />);
    expect(screen.getByTestId("link-page-age").textContent).toContain("good");
    setFreshness({ kind: "stale", ageMillis: 800 });
    expect(screen.getByTestId("link-page-age").textContent).toContain("bad");
  });

  it("draw a curve with its gaps left open", () => {
    expect(linesOf([1, 2, null, 3])).toHaveLength(2);
    expect(linesOf([null, null])).toEqual([]);
  });
});
