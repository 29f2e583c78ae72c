/** Numbers as people type them. Pure. */

/** Three numbers; null where nothing was typed at all, `bad` where something else was. A decimal comma is taken too. */
export function numbersOf(typed: readonly [string, string, string]): [number, number, number] | null | "bad" {
  const trimmed = typed.map((text) => text.trim().replace(",", "."));
  if (trimmed.every((text) => text === "")) return null;
  const [x, y, z] = trimmed.map((text) => (/^[-+]?(\d+\.?\d*|\.\d+)$/.test(text) ? Number(text) : Number.NaN));
  return x === undefined || y === undefined || z === undefined || [x, y, z].some(Number.isNaN) ? "bad" : [x, y, z];
}
