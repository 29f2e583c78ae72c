/** Reasons where they come in untyped: in problems, and in the particulars of stored events. */
import type { Reason } from "./types";

/** Whether a value has the form of a reason; its id may be one that this page does not know. */
export function isReason(value: unknown): value is Reason {
  return typeof value === "object" && value !== null && "id" in value && typeof value.id === "string";
}
