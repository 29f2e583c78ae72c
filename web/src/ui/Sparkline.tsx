/** A small curve of the last minute; gaps stay gaps. */
import { For, type JSX } from "solid-js";

/** One curve, its greatest value at the top. */
export function Sparkline(props: { readonly values: readonly (number | null)[]; readonly label: string }): JSX.Element {
  return (
    <svg class="spark" viewBox={`0 0 ${WIDTH} ${HEIGHT}`} preserveAspectRatio="none" role="img" aria-label={props.label}>
      <For each={linesOf(props.values)}>{(line) => <path d={line} vector-effect="non-scaling-stroke" />}</For>
    </svg>
  );
}

/** The curve's parts between gaps; a lone value is a short dash. */
export function linesOf(values: readonly (number | null)[]): readonly string[] {
  const most = Math.max(...values.filter((value) => value !== null), 1e-9);
  const step = WIDTH / values.length;
  const lines: string[] = [];
  let line = "";
  for (const [index, value] of values.entries()) {
    if (value === null) {
      if (line !== "") lines.push(line);
      line = "";
      continue;
    }
    const [x, y] = [index * step, (HEIGHT - 1) * (1 - Math.max(0, value) / most) + 0.5];
    line += `${line === "" ? "M" : "L"}${x.toFixed(1)} ${y.toFixed(1)}L${(x + step).toFixed(1)} ${y.toFixed(1)}`;
  }
  return line === "" ? lines : [...lines, line];
}

const WIDTH = 120;
const HEIGHT = 18;
