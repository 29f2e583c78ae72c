import { render } from "solid-js/web";
import { App } from "./views/App";
import "./style/colours.css";
import "./style/base.css";
import "./style/strip.css";
import "./style/shell.css";
import "./style/picture.css";
import "./style/panels.css";
import "./style/desk.css";
import "./style/weights.css";
import "./style/timeline.css";
import "./style/records.css";
import "./style/scenes.css";
import "./style/sessions.css";
import "./style/settings.css";

const root = document.getElementById("root");
if (root === null) throw new Error("the page has no root");
render(() => <App />, root);
