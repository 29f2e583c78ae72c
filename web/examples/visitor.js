// A VR client in JavaScript alone: one visitor who walks after the mouse, ROS axes (the room's own: x right, y up on the canvas, z up; m).
const server = new URLSearchParams(location.search).get("server")
  ?? (location.protocol === "file:" ? "ws://127.0.0.1:7878" : location.origin.replace(/^http/, "ws"));
const canvas = document.getElementById("room"), pen = canvas.getContext("2d"), SIDE_M = 4, WALK_MPS = 1;
const show = (id, text) => { document.getElementById(id).textContent = text; };
const micros = () => Math.round(performance.now() * 1000);
const px = (m) => (m / SIDE_M) * canvas.width;
const heard = {}, head = { x: 2, y: 0.8, yaw: Math.PI / 2 }, goal = { x: 2, y: 0.8 };
let sequence = 0, pings = 0, previous;

const socket = new WebSocket(server + "/ws/v1/client", "covr.v1.json");
const say = (message) => { if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message)); };
socket.onopen = () => {
  say({ type: "hello", name: "example page", convention: "ros", token: location.hash.slice(1) || undefined });
  say({ type: "enter", person: "visitor" });
  setInterval(() => say({ type: "clock_ping", id: ++pings, client_time_micros: micros(), previous }), 1000);
  setInterval(pose, 1000 / 90);
};
function pose() {
  const [dx, dy] = [goal.x - head.x, goal.y - head.y], far = Math.hypot(dx, dy), step = Math.min(far, WALK_MPS / 90);
  if (far > 0.01) Object.assign(head, { x: head.x + (dx / far) * step, y: head.y + (dy / far) * step, yaw: Math.atan2(dy, dx) });
  say({
    type: "pose", person: "visitor", sequence: ++sequence, client_time_micros: micros(), position: [head.x, head.y, 1.65],
    orientation: [0, 0, Math.sin(head.yaw / 2), Math.cos(head.yaw / 2)], tracked: true, worn: true,
  });
}
socket.onmessage = ({ data }) => {
  const message = JSON.parse(data);
  if (message.type === "welcome") heard.scene = message.scene;
  else if (message.type === "clock_pong") previous = { id: message.id, received_client_time_micros: micros() };
  else if (message.type === "error") show("said", message.message);
  else heard[message.type] = message;
  draw();
};
socket.onclose = ({ code, reason }) => show("state", `closed (${code}) ${reason || "is the server there, and may this page connect?"}`);
canvas.onpointermove = ({ offsetX: x, offsetY: y }) => Object.assign(goal, { x: (x / canvas.width) * SIDE_M, y: (1 - y / canvas.height) * SIDE_M });
addEventListener("pagehide", () => say({ type: "leave", person: "visitor" }));

function dot(x, y, r, colour) {
  pen.fillStyle = colour;
  pen.fill(new Path2D(`M${px(x) - r} ${px(SIDE_M - y)}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`));
}
function draw() {
  const { column, prediction, stop, scene } = heard;
  pen.clearRect(0, 0, canvas.width, canvas.height);
  for (const { object, position } of scene?.places ?? []) dot(position[0], position[1], 6, object === prediction?.object ? "orange" : "gray");
  if (column) dot(column.position[0], column.position[1], px(0.15), column.homed ? "steelblue" : "lightgray");
  dot(head.x, head.y, px(0.12), "seagreen");
  if (column) show("state", stop?.stopped ? `stopped: ${stop.reason}` : `${column.mode}, column at ${column.position.map((m) => m.toFixed(2)).join(", ")}`);
  if (prediction) show("said", `${prediction.object} is next (${Math.round(prediction.probability * 100)} %), column there in ${prediction.arrival_secs.toFixed(1)} s, in time: ${prediction.in_time_probability === null ? "–" : `${Math.round(prediction.in_time_probability * 100)} %`}`);
}
