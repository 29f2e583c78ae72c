/** A change between two versions of a scene, in words. */
import { words } from "../../i18n";
import { metres } from "../../lib/format";
import type { SceneChange } from "../../lib/sceneDiff";

/** In the page's language. */
export function changeWords(change: SceneChange): string {
  const say = words().records.diff;
  switch (change.kind) {
    case "field":
      return say.fieldChanged(say.field[change.field]);
    case "added":
      return say.addedThing(say.part[change.part], change.name);
    case "removed":
      return say.removedThing(say.part[change.part], change.name);
    case "moved":
      return say.moved(change.name, metres(change.byM));
    case "prior":
      return say.prior(change.name, change.from, change.to);
    case "switched":
      return change.on ? say.switchedOn(change.name) : say.switchedOff(change.name);
    case "changed":
      return say.changedThing(say.part[change.part], change.name, change.fields.join(", "));
  }
}
