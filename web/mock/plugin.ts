/** Hangs the mock on Vite's own server, for `npm run dev` and `npm run preview`. */
import type { IncomingMessage, Server, ServerResponse } from "node:http";
import type { Plugin } from "vite";
import { MockServer } from "./server.ts";

interface Host {
  readonly httpServer: Pick<Server, "on"> | null;
  readonly middlewares: { use: (handler: (request: IncomingMessage, response: ServerResponse, next: () => void) => void) => unknown };
}

/** The mock as a plugin. */
export function mockServer(): Plugin {
  const serve = (host: Host): void => {
    const mock = new MockServer();
    if (host.httpServer !== null) {
      mock.attach(host.httpServer);
      host.httpServer.on("close", () => {
        mock.close();
      });
    }
    host.middlewares.use((request, response, next) => {
      if (!mock.handle(request, response)) next();
    });
  };
  return {
    name: "covr-mock",
    configureServer: (server) => {
      serve(server as Host);
    },
    configurePreviewServer: (server) => {
      serve(server as Host);
    },
  };
}
