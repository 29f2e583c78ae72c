/** What follows the view's name in the address: `#/sessions/12?t=34.5` is part `12` with `t` being `34.5`. */
import { createSignal, onCleanup, onMount, type Accessor } from "solid-js";

/** A place within a view. */
export interface Address {
  readonly parts: readonly string[];
  readonly query: ReadonlyMap<string, string>;
}

/** Reads a hash. */
export function addressOf(hash: string): Address {
  const [path = "", query = ""] = hash.split("?", 2);
  return { parts: path.replace(/^#\//, "").split("/").slice(1).filter((part) => part !== ""), query: new Map(new URLSearchParams(query)) };
}

/** A whole number above zero; null for anything else. */
export function wholeNumber(text: string | undefined): number | null {
  return text !== undefined && /^[1-9][0-9]{0,14}$/.test(text) ? Number(text) : null;
}

/** Seconds from zero on; null for anything else. */
export function secondsOf(text: string | undefined): number | null {
  return text !== undefined && /^[0-9]{1,9}(\.[0-9]{1,6})?$/.test(text) ? Number(text) : null;
}

/** The address of the page, following it. */
export function createAddress(): Accessor<Address> {
  const [address, setAddress] = createSignal(addressOf(location.hash));
  onMount(() => {
    const changed = (): void => {
      setAddress(addressOf(location.hash));
    };
    window.addEventListener("hashchange", changed);
    onCleanup(() => {
      window.removeEventListener("hashchange", changed);
    });
  });
  return address;
}
