// @vitest-environment happy-dom
import { cleanup, fireEvent, render, screen } from "@solidjs/testing-library";
import { afterEach, describe, expect, it, vi } from "vitest";
import { Unreachable } from "../api/http";
import { StopButton } from "./StopButton";
import { StopReport } from "./StopReport";

afterEach(cleanup);

function page(): { press: ReturnType<typeof vi.fn<() => void>>; field: HTMLInputElement; other: HTMLButtonElement } {
  const press = vi.fn<() => void>();
  render(() => (
    <>
      <StopButton press={press} />
      <input type="text" aria-label="name" />
      <input type="range" aria-label="prior" />
      <button type="button">other</button>
    </>
  ));
  return {
    press,
    field: screen.getByLabelText("name"),
    other: screen.getByText("other"),
  };
}

describe("the stop button", () => {
  it("says what it is and what it is not", () => {
    page();
    const button = screen.getByTestId("stop");
    expect(button.textContent).toContain("software stop");
    expect(document.body.textContent).toContain("wired stop chain is elsewhere");
    expect(button.hasAttribute("disabled")).toBe(false);
  });

  it("presses when the pointer goes down, once a press", () => {
    const { press } = page();
    const button = screen.getByTestId("stop");
    fireEvent.pointerDown(button, { button: 0 });
    fireEvent.click(button, { detail: 1 });
    expect(press).toHaveBeenCalledTimes(1);
  });

  it("presses by Enter and assistive technology, which only click", () => {
    const { press } = page();
    fireEvent.click(screen.getByTestId("stop"), { detail: 0 });
    expect(press).toHaveBeenCalledTimes(1);
  });

  it("presses by Escape anywhere, and by Space wherever it writes nothing", () => {
    const { press, field, other } = page();
    fireEvent.keyDown(field, { key: "Escape", code: "Escape" });
    fireEvent.keyDown(document.body, { key: " ", code: "Space" });
    fireEvent.keyDown(other, { key: " ", code: "Space" });
    fireEvent.keyDown(screen.getByLabelText("prior"), { key: " ", code: "Space" });
    expect(press).toHaveBeenCalledTimes(4);
    fireEvent.keyDown(field, { key: " ", code: "Space" });
    fireEvent.keyDown(document.body, { key: "a", code: "KeyA" });
    fireEvent.keyDown(document.body, { key: " ", code: "Space", ctrlKey: true });
    expect(press).toHaveBeenCalledTimes(4);
  });

  it("presses once while a key is held, and keeps the key from pressing what has the focus", () => {
    const { press, other } = page();
    expect(fireEvent.keyDown(other, { key: " ", code: "Space" })).toBe(false);
    expect(fireEvent.keyDown(other, { key: " ", code: "Space", repeat: true })).toBe(false);
    expect(fireEvent.keyUp(other, { key: " ", code: "Space" })).toBe(false);
    expect(press).toHaveBeenCalledTimes(1);
  });
});

describe("the stop report", () => {
  it("says nothing before a press", () => {
    render(() => <StopReport stop={{ kind: "idle" }} nowMillis={0} />);
    expect(screen.getByTestId("stop-report").textContent).toBe("");
  });

  it("says that it is not acknowledged, for how long and why", () => {
    render(() => (
      <StopReport stop={{ kind: "pending", pressedAtMillis: 1000, sent: 4, trouble: { kind: "failed", error: new Unreachable(null) } }} nowMillis={2300} />
    ));
    const text = screen.getByTestId("stop-pending").textContent;
    expect(text).toContain("NOT ACKNOWLEDGED, retrying");
    expect(text).toContain("1.3 s since the press");
    expect(text).toContain("no connection to the server");
  });

  it("says both times and the lane", () => {
    render(() => (
      <StopReport
        stop={{ kind: "acknowledged", pressedAtMillis: 0, acknowledgedMillis: 6.2, toDriveMicros: 1840, lane: "http", sent: 1, detail: null }}
        nowMillis={9}
      />
    ));
    const text = screen.getByTestId("stop-acknowledged").textContent;
    expect(text).toContain("stopped: acknowledged in 6.2 ms,");
    expect(text).toContain("reached the drive in 1.8 ms, by HTTP");
  });
});
