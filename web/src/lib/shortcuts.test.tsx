// @vitest-environment happy-dom
import { cleanup, fireEvent, render, screen } from "@solidjs/testing-library";
import { createSignal, type JSX } from "solid-js";
import { afterEach, describe, expect, it, vi } from "vitest";
import { listenForShortcuts, shortcuts, useShortcuts, type Shortcut } from "./shortcuts";

afterEach(cleanup);

function shortcut(key: string, run: () => void, within?: Shortcut["within"]): Shortcut {
  return { key, group: "page", does: () => key, run, ...(within === undefined ? {} : { within }) };
}

function page(): { theme: ReturnType<typeof vi.fn>; zoom: ReturnType<typeof vi.fn>; one: ReturnType<typeof vi.fn>; enable: (on: boolean) => void; only: (keys: ReadonlySet<string> | null) => void } {
  const [theme, zoom, one] = [vi.fn(), vi.fn(), vi.fn()];
  const [enabled, enable] = createSignal(true);
  const [only, setOnly] = createSignal<ReadonlySet<string> | null>(null);
  const Page = (): JSX.Element => {
    useShortcuts([shortcut("t", theme), shortcut("1", one), shortcut("+", zoom, () => screen.getByTestId("picture"))]);
    listenForShortcuts(enabled, only);
    return (
      <>
        <input type="text" aria-label="name" />
        <input type="range" aria-label="prior" />
        <select aria-label="kind" />
        <div data-testid="picture" tabindex="0" />
      </>
    );
  };
  render(() => <Page />);
  return { theme, zoom, one, enable, only: (keys) => setOnly(keys) };
}

describe("shortcuts", () => {
  it("fire anywhere but where somebody writes, and never with Ctrl, Alt or Meta", () => {
    const { theme } = page();
    fireEvent.keyDown(document.body, { key: "t" });
    fireEvent.keyDown(screen.getByLabelText("prior"), { key: "T", shiftKey: true });
    expect(theme).toHaveBeenCalledTimes(2);
    for (const field of ["name", "kind"]) fireEvent.keyDown(screen.getByLabelText(field), { key: "t" });
    for (const held of ["ctrlKey", "altKey", "metaKey"]) fireEvent.keyDown(document.body, { key: "t", [held]: true });
    fireEvent.keyDown(document.body, { key: "t", repeat: true });
    expect(theme).toHaveBeenCalledTimes(2);
  });

  it("know a digit by its place where the keyboard has it above Shift", () => {
    const { one } = page();
    fireEvent.keyDown(document.body, { key: "&", code: "Digit1" });
    fireEvent.keyDown(document.body, { key: "1", code: "Digit1", shiftKey: true });
    expect(one).toHaveBeenCalledTimes(2);
  });

  it("of a picture work there alone", () => {
    const { zoom } = page();
    fireEvent.keyDown(document.body, { key: "+" });
    expect(zoom).not.toHaveBeenCalled();
    fireEvent.keyDown(screen.getByTestId("picture"), { key: "+" });
    expect(zoom).toHaveBeenCalledTimes(1);
  });

  it("are silent when turned off, and in a dialog but for its own", () => {
    const { theme, one, enable, only } = page();
    only(new Set(["t"]));
    fireEvent.keyDown(document.body, { key: "1" });
    fireEvent.keyDown(document.body, { key: "t" });
    enable(false);
    fireEvent.keyDown(document.body, { key: "t" });
    expect([theme.mock.calls.length, one.mock.calls.length]).toEqual([1, 0]);
  });

  it("are listed while they work, and never take a key of the stop or one that is taken", () => {
    page();
    expect(shortcuts().map(({ key }) => key)).toEqual(["t", "1", "+"]);
    const take = (key: string) => (): void => {
      useShortcuts([shortcut(key, () => undefined)]);
    };
    for (const key of ["t", "Escape", " "]) expect(take(key), key).toThrow(`the key ${key} `);
    cleanup();
    expect(shortcuts()).toEqual([]);
  });
});
