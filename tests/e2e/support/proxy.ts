/** A wire between browser and server that can be cut for WebSockets alone: HTTP goes on. */
import { connect, createServer, type AddressInfo, type Server, type Socket } from "node:net";
import { onTestFinished } from "vitest";

/** What happens to WebSockets. */
export type SocketFate = "passed" | "cut" | "swallowed";

/** One such wire. */
export class SocketCutter {
  readonly #server: Server;
  readonly #sockets = new Set<readonly [Socket, Socket]>();
  readonly #all = new Set<Socket>();
  #fate: SocketFate = "passed";

  private constructor(targetPort: number) {
    this.#server = createServer((client) => {
      this.#all.add(client);
      client.on("close", () => this.#all.delete(client));
      client.on("error", () => client.destroy());
      client.once("data", (first) => {
        this.#join(client, first, targetPort);
      });
    });
  }

  /** Listens on a free port before a server's, until the test ends. */
  static async before(targetPort: number): Promise<SocketCutter> {
    const cutter = new SocketCutter(targetPort);
    onTestFinished(() => cutter.#end());
    await new Promise<void>((resolve) => cutter.#server.listen(0, "127.0.0.1", resolve));
    return cutter;
  }

  /** Where the browser goes. */
  get url(): string {
    return `http://127.0.0.1:${(this.#server.address() as AddressInfo).port}`;
  }

  /** `cut` closes WebSockets and lets no new one through; `swallowed` leaves them open and delivers nothing to the server. */
  set fate(fate: SocketFate) {
    this.#fate = fate;
    if (fate === "cut") for (const [client, upstream] of this.#sockets) [client, upstream].forEach((end) => end.destroy());
    if (fate === "swallowed") for (const [client, upstream] of this.#sockets) client.unpipe(upstream).resume();
  }

  async #end(): Promise<void> {
    for (const socket of this.#all) socket.destroy();
    await new Promise((resolve) => this.#server.close(resolve));
  }

  #join(client: Socket, first: Buffer, targetPort: number): void {
    const isWebSocket = first.toString("latin1").startsWith("GET /ws/");
    if (isWebSocket && this.#fate !== "passed") {
      client.destroy();
      return;
    }
    const upstream = connect(targetPort, "127.0.0.1");
    const pair = [client, upstream] as const;
    if (isWebSocket) this.#sockets.add(pair);
    upstream.on("error", () => client.destroy());
    upstream.on("close", () => {
      this.#sockets.delete(pair);
      client.destroy();
    });
    client.on("close", () => upstream.destroy());
    upstream.write(first);
    client.pipe(upstream);
    upstream.pipe(client);
  }
}
