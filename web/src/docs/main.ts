/** The page at /api/docs: the server's own two documents, rendered from embedded files alone. It only reads. */
import SwaggerUIBundle from "swagger-ui-dist/swagger-ui-es-bundle.js";
import "swagger-ui-dist/swagger-ui.css";
import "./docs.css";
import { renderSockets } from "./sockets";

SwaggerUIBundle({
  url: "/api/v1/openapi.json",
  dom_id: "#http",
  deepLinking: true,
  docExpansion: "list",
  defaultModelsExpandDepth: 0,
  // Nothing here may move the machine: on this page there is no stop.
  supportedSubmitMethods: [],
  // The default asks a server elsewhere.
  validatorUrl: null,
});

const sockets = document.getElementById("sockets");
if (sockets !== null) await renderSockets("/api/v1/asyncapi.json", sockets);
