import { fileURLToPath } from "node:url";
import { defineConfig } from "vitest/config";
import solid from "vite-plugin-solid";
import { mockServer } from "./mock/plugin.ts";

/** The real server to proxy to, such as `http://127.0.0.1:7878`; without it `npm run dev` serves a mock. */
const server = process.env["COVR_SERVER"];
/** Unit tests make their own mocks. */
const isTest = process.env["VITEST"] !== undefined;
const proxy = server === undefined ? {} : { "/api": server, "/ws": { target: server, ws: true } };

export default defineConfig({
  plugins: [solid(), ...(server === undefined && !isTest ? [mockServer()] : [])],
  server: { proxy },
  preview: { proxy },
  build: {
    outDir: process.env["COVR_WEB_OUT"] ?? "dist",
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0,
  },
  test: {
    environment: "node",
    // Components are tested as a browser would load them; the mock's sockets are Node's all the same.
    alias: { ws: fileURLToPath(import.meta.resolve("ws")) },
    include: ["src/**/*.test.{ts,tsx}", "mock/**/*.test.ts"],
    server: { deps: { inline: [/solid-js/, /@solidjs/] } },
  },
});
