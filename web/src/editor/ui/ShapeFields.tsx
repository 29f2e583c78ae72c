/** Shapes: an object's surface, and a keep-out's or a zone's place on the floor. */
import { For, Match, Show, Switch, type JSX } from "solid-js";
import type { KeepOutDocument, ShapeDocument } from "../../api/types";
import type { Editor } from "../editor";
import { rounded } from "../scene";
import { say } from "../words";
import { ChoiceField, NumberField, Row } from "./fields";

type FloorShapeDocument = KeepOutDocument["shape"];

/** A surface. */
export function ObjectShape(props: { readonly editor: Editor; readonly shape: ShapeDocument; readonly path: string; readonly set: (shape: ShapeDocument) => void }): JSX.Element {
  const kinds = (): readonly ShapeDocument["kind"][] => (isMesh(props.shape) ? ["sphere", "box", "cylinder", props.shape.kind] : ["sphere", "box", "cylinder"]);
  return (
    <>
      <ChoiceField
        editor={props.editor}
        label={say().form.shape}
        testId="shape-kind"
        value={props.shape.kind}
        options={kinds().map((kind) => ({ value: kind, word: say().form.shapes[kind] }))}
        set={(kind) => { if (kind !== props.shape.kind) props.set(ofKind(kind, props.shape)); }}
      />
      <Switch>
        <Match when={props.shape.kind === "sphere" ? props.shape : null}>
          {(ball) => <NumberField editor={props.editor} label={say().form.radius} unit="m" testId="shape-radius" path={`${props.path}.radius`} value={ball().radius} set={(radius) => { props.set({ ...ball(), radius }); }} />}
        </Match>
        <Match when={props.shape.kind === "box" ? props.shape : null}>
          {(box) => (
            <Row label={say().form.size}>
              <For each={["x", "y", "z"] as const}>
                {(axis, index) => (
                  <NumberField
                    editor={props.editor}
                    label={axis}
                    unit="m"
                    testId={`shape-size-${axis}`}
                    {...(index() === 0 ? { path: `${props.path}.size` } : {})}
                    value={box().size[index()] ?? 0}
                    set={(value) => { props.set({ ...box(), size: box().size.map((old, at) => (at === index() ? value : old)) as [number, number, number] }); }}
                  />
                )}
              </For>
            </Row>
          )}
        </Match>
        <Match when={props.shape.kind === "cylinder" ? props.shape : null}>
          {(cylinder) => (
            <Row label={say().form.size}>
              <NumberField editor={props.editor} label={say().form.radius} unit="m" testId="shape-radius" path={`${props.path}.radius`} value={cylinder().radius} set={(radius) => { props.set({ ...cylinder(), radius }); }} />
              <NumberField editor={props.editor} label={say().form.height} unit="m" testId="shape-height" path={`${props.path}.height`} value={cylinder().height} set={(height) => { props.set({ ...cylinder(), height }); }} />
            </Row>
          )}
        </Match>
        <Match when={true}>
          <p class="empty">{say().form.mesh(pointsOf(props.shape))}</p>
        </Match>
      </Switch>
    </>
  );
}

/** A place on the floor. */
export function FloorShape(props: { readonly editor: Editor; readonly shape: FloorShapeDocument; readonly path: string; readonly set: (shape: FloorShapeDocument) => void }): JSX.Element {
  const circle = () => (props.shape.kind === "circle" ? props.shape : null);
  const polygon = () => (props.shape.kind === "polygon" ? props.shape : null);
  return (
    <>
      <ChoiceField
        editor={props.editor}
        label={say().form.shape}
        testId="floor-kind"
        value={props.shape.kind}
        options={[{ value: "circle", word: say().form.circle }, { value: "polygon", word: say().form.polygon }]}
        set={(kind) => { if (kind !== props.shape.kind) props.set(turned(props.shape)); }}
      />
      <Show when={circle()}>
        {(disc) => (
          <Row label={say().form.centre}>
            <NumberField editor={props.editor} label="x" unit="m" testId="centre-x" path={`${props.path}.centre`} value={disc().centre[0]} set={(x) => { props.set({ ...disc(), centre: [x, disc().centre[1]] }); }} />
            <NumberField editor={props.editor} label="y" unit="m" testId="centre-y" value={disc().centre[1]} set={(y) => { props.set({ ...disc(), centre: [disc().centre[0], y] }); }} />
            <NumberField editor={props.editor} label={say().form.radius} unit="m" testId="floor-radius" path={`${props.path}.radius`} value={disc().radius} set={(radius) => { props.set({ ...disc(), radius }); }} />
          </Row>
        )}
      </Show>
      <Show when={polygon()}>
        {(shape) => (
          <>
            <For each={shape().corners.map((_, index) => index)}>
              {(index) => (
                <Row label={say().plan.corner(index + 1)}>
                  <For each={[0, 1] as const}>
                    {(axis) => (
                      <NumberField
                        editor={props.editor}
                        label={axis === 0 ? "x" : "y"}
                        unit="m"
                        testId={`corner-${index}-${axis === 0 ? "x" : "y"}`}
                        {...(axis === 0 ? { path: `${props.path}.corners[${index}]` } : {})}
                        value={shape().corners[index]?.[axis] ?? 0}
                        set={(value) => { props.set({ ...shape(), corners: shape().corners.map((corner, at) => (at === index ? (corner.map((old, place) => (place === axis ? value : old)) as [number, number]) : corner)) }); }}
                      />
                    )}
                  </For>
                  <button type="button" class="quiet" disabled={shape().corners.length < 4} aria-label={say().form.removeCorner(index + 1)} onClick={() => { props.set({ ...shape(), corners: shape().corners.filter((_, at) => at !== index) }); }}>
                    ✕
                  </button>
                </Row>
              )}
            </For>
            <button type="button" data-testid="add-corner" onClick={() => { props.set({ ...shape(), corners: withAnother(shape().corners) }); }}>
              {say().form.addCorner}
            </button>
          </>
        )}
      </Show>
    </>
  );
}

function isMesh(shape: ShapeDocument): boolean {
  return shape.kind === "convex_mesh" || shape.kind === "triangle_mesh";
}

function pointsOf(shape: ShapeDocument): number {
  return shape.kind === "convex_mesh" ? shape.points.length : shape.kind === "triangle_mesh" ? shape.vertices.length : 0;
}

/** Another kind of about the same extent. */
function ofKind(kind: string, from: ShapeDocument): ShapeDocument {
  const radius = from.kind === "sphere" || from.kind === "cylinder" ? from.radius : from.kind === "box" ? rounded(Math.min(from.size[0], from.size[1]) / 2) : 0.1;
  const height = from.kind === "cylinder" ? from.height : from.kind === "box" ? from.size[2] : rounded(2 * radius);
  switch (kind) {
    case "box":
      return { kind, size: [rounded(2 * radius), rounded(2 * radius), height] };
    case "cylinder":
      return { kind, radius, height };
    default:
      return { kind: "sphere", radius };
  }
}

/** A circle as a square about it, a polygon as the circle about its middle. */
function turned(shape: FloorShapeDocument): FloorShapeDocument {
  if (shape.kind === "circle") {
    const { centre: [x, y], radius } = shape;
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([right = 0, up = 0]): [number, number] => [rounded(x + right * radius), rounded(y + up * radius)]);
    return { kind: "polygon", corners };
  }
  const count = Math.max(1, shape.corners.length);
  const centre: [number, number] = [rounded(shape.corners.reduce((sum, [x]) => sum + x, 0) / count), rounded(shape.corners.reduce((sum, [, y]) => sum + y, 0) / count)];
  const radius = Math.max(0.05, ...shape.corners.map(([x, y]) => Math.hypot(x - centre[0], y - centre[1])));
  return { kind: "circle", centre, radius: rounded(radius) };
}

/** One more between the last and the first, a little outside, so that it is seen. */
function withAnother(corners: readonly [number, number][]): [number, number][] {
  const last = corners.at(-1) ?? ([0, 0] as const);
  const first = corners[0] ?? ([0, 0] as const);
  const middle: [number, number] = [(last[0] + first[0]) / 2, (last[1] + first[1]) / 2];
  const [dx, dy] = [first[0] - last[0], first[1] - last[1]];
  const length = Math.max(1e-6, Math.hypot(dx, dy));
  const turn = corners.length < 3 || area(corners) > 0 ? 1 : -1;
  return [...corners, [rounded(middle[0] + (turn * dy * 0.1) / length), rounded(middle[1] - (turn * dx * 0.1) / length)]];
}

/** Twice the area, positive counter-clockwise. */
function area(corners: readonly [number, number][]): number {
  return corners.reduce((sum, [x, y], index) => {
    const [nextX, nextY] = corners[(index + 1) % corners.length] ?? [0, 0];
    return sum + x * nextY - nextX * y;
  }, 0);
}
