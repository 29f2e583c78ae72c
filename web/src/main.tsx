import { render } from "solid-js/web";
import { App } from "./views/App";
import "./style.css";

const root = document.getElementById("root");
if (root === null) throw new Error("the page has no root");
render(() => <App />, root);
