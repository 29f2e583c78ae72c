import js from "@eslint/js";
import { defineConfig } from "eslint/config";
import tseslint from "typescript-eslint";

const EXAMPLE_GLOBALS = ["addEventListener", "document", "location", "Path2D", "performance", "setInterval", "URLSearchParams", "WebSocket"];

export default defineConfig(
  { ignores: ["dist/", "src/api/generated/"] },
  js.configs.recommended,
  tseslint.configs.strictTypeChecked,
  {
    languageOptions: {
      parserOptions: { projectService: { allowDefaultProject: ["eslint.config.js"] }, tsconfigRootDir: import.meta.dirname },
    },
    rules: {
      // Leaving a field out by name is how an object goes on without it.
      "@typescript-eslint/no-unused-vars": ["error", { ignoreRestSiblings: true }],
      // Solid assigns what stands in `ref={...}`.
      "no-unassigned-vars": "off",
      // A number in a sentence needs no ceremony; anything else that would print as [object Object] is still refused.
      "@typescript-eslint/restrict-template-expressions": ["error", { allowNumber: true }],
    },
  },
  {
    files: ["src/**"],
    ignores: ["src/live/**", "src/**/*.test.*"],
    rules: {
      "no-restricted-globals": ["error", { name: "WebSocket", message: "Only src/live opens the socket." }],
    },
  },
  // Runs before everything else, as it stands.
  { files: ["public/*.js"], languageOptions: { sourceType: "script", globals: { document: "readonly", localStorage: "readonly", matchMedia: "readonly" } } },
  {
    files: ["examples/*.js"],
    languageOptions: {
      sourceType: "script",
      globals: Object.fromEntries(EXAMPLE_GLOBALS.map((name) => [name, "readonly"])),
    },
  },
  { files: ["**/*.js"], extends: [tseslint.configs.disableTypeChecked] },
);
