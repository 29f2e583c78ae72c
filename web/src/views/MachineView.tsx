/** The machine: its axes, its boards and the link to them, its calibration, and how it is configured. */
import { For, Show, type JSX } from "solid-js";
import type { Column, MachineHealth, MachineShape } from "../api/types";
import { words } from "../i18n";
import { decimal, metres } from "../lib/format";
import type { Live } from "../live/live";
import { Calibration } from "../ui/calibration/Calibration";
import { Configuration } from "../ui/Configuration";
import { Commissioning } from "../ui/Commissioning";
import { Jog } from "../ui/Jog";
import { Said } from "../ui/Said";

/** The view. */
export function MachineView(props: { readonly live: Live; readonly author: string }): JSX.Element {
  return (
    <div class="sheet">
      <h1>{words().machine.title}</h1>
      <p class="empty">{words().machine.driven(props.live.server()?.machine ?? words().machine.board.unknown)}</p>
      <Show when={props.live.snapshot()} fallback={<p>{words().machine.noValues}</p>}>
        {(snapshot) => (
          <>
            <Axes column={snapshot().column} shape={props.live.server()?.shape ?? null} />
            <Jog live={props.live} />
            <Commissioning live={props.live} />
            <Show
              when={snapshot().machine_health}
              fallback={
                <section class="panel" aria-labelledby="board-title">
                  <h2 id="board-title">{words().machine.board.title}</h2>
                  <p data-testid="machine-no-board">{words().machine.board.none}</p>
                </section>
              }
            >
              {(health) => (
                <>
                  <Board health={health()} />
                  <Link health={health()} />
                </>
              )}
            </Show>
          </>
        )}
      </Show>
      <Calibration live={props.live} author={props.author} />
      <Configuration search="machine." />
    </div>
  );
}

function Axes(props: { readonly column: Column; readonly shape: MachineShape | null }): JSX.Element {
  const say = () => words().machine.axes;
  const name = (axis: 0 | 1): string => (axis === 0 ? say().names.x : say().names.y);
  const limits = (axis: 0 | 1): string => {
    const shape = props.shape;
    if (shape === null) return "";
    return say().limitsAre(decimal(shape.speed_mps[axis], 2), decimal(shape.acceleration_mps2[axis], 2), decimal(shape.braking_mps2[axis], 2));
  };
  const travel = (axis: 0 | 1): string => {
    const shape = props.shape;
    return shape === null ? "" : `${decimal(shape.travel_m[axis], 2)} – ${decimal(shape.travel_m[axis === 0 ? 2 : 3], 2)} m`;
  };
  return (
    <section class="panel" aria-labelledby="axes-title">
      <h2 id="axes-title">{say().title}</h2>
      <table>
        <thead>
          <tr>
            <For each={[say().axis, say().position, say().commanded, say().velocity, say().current, say().travel]}>
              {(title) => <th scope="col">{title}</th>}
            </For>
          </tr>
        </thead>
        <tbody>
          <For each={[0, 1] as const}>
            {(axis) => (
              <tr data-testid={`machine-axis-${axis === 0 ? "x" : "y"}`}>
                <th scope="row">{name(axis)}</th>
                <td>{metres(props.column.position_m[axis])} m</td>
                <td>{metres(props.column.commanded_m[axis])} m</td>
                <td>{decimal(props.column.velocity_mps[axis], 2)} m/s</td>
                <td>{decimal(props.column.current_amps[axis], 2)} A</td>
                <td>{travel(axis)}</td>
              </tr>
            )}
          </For>
        </tbody>
      </table>
      <dl class="facts">
        <For each={[0, 1] as const}>{(axis) => <Fact name={`${say().limits}${words().shell.colon}${name(axis)}`} value={limits(axis)} />}</For>
      </dl>
      <p class="empty">{props.column.homed ? say().homed : say().notHomed}</p>
      <Show when={props.column.home_repeatability_m}>
        {(found) => (
          <p class="empty" data-testid="home-repeatability">
            {say().repeatability(decimal(found()[0] * 1000, 2), decimal(found()[1] * 1000, 2))}
          </p>
        )}
      </Show>
    </section>
  );
}

function Board(props: { readonly health: MachineHealth }): JSX.Element {
  const say = () => words().machine.board;
  const trouble = () => props.health.trouble;
  return (
    <section class="panel" aria-labelledby="board-title">
      <h2 id="board-title">{say().title}</h2>
      <p classList={{ answer: trouble() !== null, refused: trouble() !== null }} data-testid="machine-state">
        <Show when={trouble()} fallback={say().fine}>
          {(found) => words().troubles[found()]}
        </Show>
      </p>
      <Show when={props.health.condition !== ""}>
        <p class="empty">
          <Said of={{ text: props.health.condition, lang: "en" }} />
        </p>
      </Show>
      <dl class="facts">
        <Fact name={say().firmware} value={props.health.firmware ?? say().unknown} testId="machine-firmware" />
        <Fact name={say().profile} value={props.health.profile === null ? say().unknown : say().profileIs(props.health.profile)} />
        <Fact name={say().supply} value={props.health.supply_volts === null ? say().unknown : `${decimal(props.health.supply_volts, 1)} V`} />
        <Fact name={say().temperature} value={props.health.temperature_c === null ? say().unknown : `${decimal(props.health.temperature_c, 1)} °C`} />
      </dl>
    </section>
  );
}

function Link(props: { readonly health: MachineHealth }): JSX.Element {
  const say = () => words().machine.link;
  const link = () => props.health.link;
  const micros = (value: number): string => decimal(value / 1000, 1);
  return (
    <section class="panel" aria-labelledby="machine-link-title">
      <h2 id="machine-link-title">{say().title}</h2>
      <dl class="facts">
        <Fact name={say().rate} value={decimal(link().rate_hz, 0)} testId="machine-rate" />
        <Fact
          name={say().cycle}
          value={`${micros(link().cycle_p50_micros)} · ${micros(link().cycle_p99_micros)} · ${micros(link().cycle_max_micros)} ms`}
        />
        <Fact name={say().exchanges} value={String(link().exchanges)} />
        <Fact name={say().lost} value={say().lostAre(String(link().lost), String(link().repeated))} />
        <Fact name={say().cyclesLost} value={String(link().cycles_lost)} />
        <Fact name={say().connections} value={String(link().connections)} />
        <Fact name={say().lastLoss} value={link().last_loss === "" ? say().nothing : link().last_loss} />
      </dl>
      <p class="empty">{say().means}</p>
    </section>
  );
}

function Fact(props: { readonly name: string; readonly value: string; readonly testId?: string }): JSX.Element {
  return (
    <div>
      <dt>{props.name}</dt>
      <dd data-testid={props.testId}>{props.value}</dd>
    </div>
  );
}
