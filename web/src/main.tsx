import { render } from "solid-js/web";
import { App } from "./views/App";
import "./style/base.css";
import "./style/shell.css";
import "./style/live.css";
import "./style/desk.css";
import "./style/records.css";
import "./style/settings.css";

const root = document.getElementById("root");
if (root === null) throw new Error("the page has no root");
render(() => <App />, root);
