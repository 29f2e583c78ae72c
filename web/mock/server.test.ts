import { createServer, type Server } from "node:http";
import type { AddressInfo } from "node:net";
import { afterEach, expect, it } from "vitest";
import { WebSocket } from "ws";
import type { ToDashboard } from "../src/api/types";
import { parseFrame } from "../src/live/frames";
import { MockServer } from "./server";

let mock: MockServer | null = null;
let host: Server | null = null;

afterEach(() => {
  mock?.close();
  host?.close();
});

it("speaks the dashboard's contract: every frame is understood, and a stop is answered and latched", async () => {
  const serving = new MockServer();
  mock = serving;
  const server = createServer((request, response) => {
    if (!serving.handle(request, response)) response.writeHead(404).end();
  });
  host = server;
  serving.attach(server);
  await new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve));
  const address = `127.0.0.1:${(server.address() as AddressInfo).port}`;
  const socket = new WebSocket(`ws://${address}/ws/v1/dashboard`);
  const received: ToDashboard[] = [];
  const latched = new Promise<void>((resolve, reject) => {
    socket.on("error", reject);
    socket.on("message", (data: Buffer) => {
      const parsed = parseFrame(data.toString());
      if ("trouble" in parsed) {
        reject(new Error(parsed.trouble));
        return;
      }
      received.push(parsed.message);
      if (received.length === 4) socket.send(JSON.stringify({ type: "stop", request_id: 9, reason: null }));
      const last = parsed.message;
      if (last.type === "snapshot" && last.mode === "latched_stop") resolve();
    });
  });
  await latched;
  socket.close();
  expect(received.slice(0, 2).map((message) => message.type)).toEqual(["welcome", "scene"]);
  expect(received.find((message) => message.type === "answer")).toMatchObject({ request_id: 9, outcome: "accepted" });
  const home = await fetch(`http://${address}/api/v1/home`, { method: "POST", body: "{}" });
  expect(home.status).toBe(409);
  expect(await home.json()).toMatchObject({ detail: "the machine is stopped: reset first" });
});
