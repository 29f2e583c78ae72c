/** What people call things: the label that the designer gave, else the id. */
import type { SceneDocument } from "../api/types";

/** The label of an object of the scene. */
export function labelOf(scene: SceneDocument | null, objectId: string): string {
  const label = scene?.objects.find((object) => object.id === objectId)?.label;
  return label === undefined || label === "" ? objectId : label;
}
