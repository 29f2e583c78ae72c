/** Which view the page shows: the address's hash, `#/help/R3` being the view `help` at `R3`. */
import { createSignal, onCleanup, onMount, type Accessor } from "solid-js";

/** The views, in the order of the navigation. */
export const VIEWS = ["live", "scenario", "scenes", "sessions", "machine", "settings", "help"] as const;

/** A view by its name in the address. */
export type ViewName = (typeof VIEWS)[number];

/** A place of the page. */
export interface Route {
  readonly view: ViewName;
  /** What follows the view's name, part by part. */
  readonly rest: readonly string[];
}

/** The place that a hash names; the live view when it names none. */
export function routeOf(hash: string): Route {
  const [view, ...rest] = hash.replace(/^#\//, "").split("/");
  const found = VIEWS.find((name) => name === view);
  return found === undefined ? { view: "live", rest: [] } : { view: found, rest: rest.filter((part) => part !== "").map(decode) };
}

/** The place of the page, following the address. */
export function createRoute(): Accessor<Route> {
  const [route, setRoute] = createSignal(routeOf(location.hash));
  onMount(() => {
    const changed = (): void => {
      setRoute(routeOf(location.hash));
    };
    window.addEventListener("hashchange", changed);
    onCleanup(() => {
      window.removeEventListener("hashchange", changed);
    });
  });
  return route;
}

function decode(part: string): string {
  try {
    return decodeURIComponent(part);
  } catch {
    return part;
  }
}
