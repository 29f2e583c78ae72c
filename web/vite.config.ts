import { readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import type { Plugin } from "vite";
import { defineConfig } from "vitest/config";
import solid from "vite-plugin-solid";
import { mockServer } from "./mock/plugin.ts";

/** The real server to proxy to, such as `http://127.0.0.1:7878`; without it `npm run dev` serves a mock. */
const server = process.env["COVR_SERVER"];
/** Unit tests make their own mocks. */
const isTest = process.env["VITEST"] !== undefined;
const proxy = server === undefined ? {} : { "/api": server, "/ws": { target: server, ws: true } };

export default defineConfig({
  plugins: [solid(), asTheyStand(), compressed(), ...(server === undefined && !isTest ? [mockServer()] : [])],
  server: { proxy },
  preview: { proxy },
  build: {
    outDir: process.env["COVR_WEB_OUT"] ?? "dist",
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0,
    // Every browser that knows the page's other means preloads modules by itself.
    modulePreload: { polyfill: false },
    // The reference of the API is a page of its own, so that the dashboard does not carry its renderer.
    rolldownOptions: { input: ["index.html", "docs.html"] },
    // Swagger UI comes as one piece of 1.7 MB.
    chunkSizeWarningLimit: 2000,
  },
  test: {
    environment: "node",
    // Components are tested as a browser would load them; the mock's sockets are Node's all the same.
    alias: { ws: fileURLToPath(import.meta.resolve("ws")) },
    include: ["src/**/*.test.{ts,tsx}", "mock/**/*.test.ts"],
    server: { deps: { inline: [/solid-js/, /@solidjs/] } },
  },
});

/** Files that are served as they stand: the examples, and the licence of what is embedded. */
function asTheyStand(): Plugin {
  return {
    name: "as-they-stand",
    apply: "build",
    generateBundle() {
      const emit = (fileName: string, from: URL): void => {
        this.emitFile({ type: "asset", fileName, source: readFileSync(from) });
      };
      const examples = new URL("examples/", import.meta.url);
      for (const name of readdirSync(examples)) emit(`examples/${name}`, new URL(name, examples));
      const swagger = import.meta.resolve("swagger-ui-dist/package.json");
      for (const name of ["LICENSE", "NOTICE", "swagger-ui-es-bundle.js.LICENSE.txt"]) {
        emit(`licences/swagger-ui/${name.replace(/\.txt$/, "")}.txt`, new URL(name, swagger));
      }
    },
  };
}

/** Beside each text that is worth it, the same compressed: the server has no need to do it for every tablet. */
function compressed(): Plugin {
  return {
    name: "compressed",
    apply: "build",
    // From what was written: the bundle's own text is not final before.
    writeBundle({ dir }, bundle) {
      for (const fileName of Object.keys(bundle)) {
        const path = join(dir ?? "", fileName);
        if (!/\.(js|css|html|svg)$/.test(fileName) || statSync(path).size < 1024) continue;
        writeFileSync(`${path}.gz`, gzipSync(readFileSync(path), { level: 9 }));
      }
    },
  };
}
