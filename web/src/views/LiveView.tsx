/** Everything about the running machine on one screen. */
import type { JSX } from "solid-js";
import type { PreferenceStore } from "../lib/preferences";
import type { Live } from "../live/live";
import { Controls } from "../ui/Controls";
import { Events } from "../ui/Events";
import { Objects } from "../ui/Objects";
import { Persons } from "../ui/Persons";
import { Rules } from "../ui/Rules";
import { TopView } from "../ui/TopView";

/** Machine, persons and rules; the top view; objects and events. */
export function LiveView(props: {
  readonly live: Live;
  readonly author: string;
  /** What the present user likes. */
  readonly preferences: PreferenceStore;
}): JSX.Element {
  return (
    <div class="live">
      <h1 class="unseen">Live</h1>
      <div class="side">
        <Controls live={props.live} />
        <Persons live={props.live} />
        <Rules live={props.live} />
      </div>
      <TopView live={props.live} />
      <div class="side">
        <Objects live={props.live} author={props.author} />
        <Events live={props.live} />
      </div>
    </div>
  );
}
