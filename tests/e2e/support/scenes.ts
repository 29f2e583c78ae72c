/** Scenes for the tests. */

/** An empty square room with balls to touch, m. */
export function room(size: number, balls: readonly { id: string; position: readonly [number, number, number]; radius?: number; prior?: number }[]): unknown {
  return {
    schema: "covr.scene.v2",
    name: "A room with balls",
    arena: { min: [0, 0], max: [size, size] },
    objects: balls.map(({ id, position, radius, prior }) => ({
      id,
      position,
      shape: { kind: "sphere", radius: radius ?? 0.1 },
      prior: prior ?? 1,
    })),
  };
}
