/** The help in English. Numbers are the defaults of the server's safety parameters. */
import type { HelpText } from "./shape";

/** Plain language, for whoever stands at the desk. */
export const help: HelpText = {
  title: "Help",
  contents: "On this page",
  first: {
    title: "First steps",
    steps: [
      "Find the wired stop chain and check that it removes power. The button on this page does not.",
      "Look at the arena: nobody without a headset may be in it. Bystanders are not seen; keep them out or draw a keep-out shape.",
      "Type your name above, so that the records say who changed what.",
      "Press Home. The column looks for its switches at creep speed.",
      "Press Arm. From now on the column follows the visitor, and yields to everybody.",
      "Watch the mode in big words and the safety rules. To stop: Esc anywhere, Space unless you type, or the red button.",
      "To end: Disarm. The column brakes, then the drive is released.",
    ],
  },
  softwareStop: {
    title: "What the software stop is, and what it is not",
    paragraphs: [
      "The red button, Esc and Space press the software stop. The server brakes every axis at its limit, releases the drive at rest, and stays latched until somebody resets it with a reason. The page shows how long it took; until the server has acknowledged the press, it says so and repeats it.",
      "It is not an emergency stop. It needs this computer, the network, the server and the controller to work. The wired stop chain removes power and needs none of them. Keep it in reach; use it first when somebody is in danger, when a stop is not acknowledged, or when the machine moves and should not.",
      "The page is not a certified safety function, and neither is the server.",
    ],
  },
  kinds: {
    title: "Three kinds of stop",
    rows: [
      ["Protective stop", "The column brakes and holds. It goes on by itself once the cause has been gone for 1 s (rules R2, R9, R10, R12, R15)."],
      ["Latched stop", "The column brakes, then the drive is released. It survives a restart. Only a reset with a reason leaves it, and a reset starts nothing: arming is a second act (R1, R4, R5, R6, R7)."],
      ["Faulted", "The machine or its link cannot be trusted to obey (R8). It is left like a latched stop; then home and arm again."],
    ],
  },
  stopsTitle: "Stops: what happened, what clears it",
  stops: {
    R4: {
      title: "Software stop",
      happened: "Somebody pressed stop: on a page, by a key, over HTTP, or by a signal to the server. The banner has the reason that was given.",
      steps: [
        "Ask why it was pressed, and look at the arena.",
        "Mend what was wrong. People stay clear of the column until it is disarmed.",
        "Press Reset and write why it is safe. The machine is then disarmed; nothing moves.",
        "Press Arm. If the home was lost, press Home first.",
      ],
    },
    R1: {
      title: "Past the travel",
      happened: "The column was measured more than 1 cm outside its travel. The drive is released.",
      steps: [
        "Find out why: a slipped belt, a wrong travel in the configuration, a push.",
        "Move the column back into its travel by hand.",
        "Press Reset with the reason, then Arm. Home first if the belt slipped.",
      ],
    },
    R2: {
      title: "Tracking lost",
      happened: "The newest pose of somebody is older than 0.5 s, or their headset does not know its place, or its pose jumped faster than a head can move (6 m/s). The column brakes and holds.",
      steps: [
        "Look who it is: the list of persons says so.",
        "Ask the person to stand still until the headset finds its place. Look for covered cameras, dark corners, a full network.",
        "It clears by itself 1 s after every headset is tracked again.",
        "If the person has left the arena: look, then press the button that says so beside the name.",
      ],
    },
    R5: {
      title: "Motor current too high",
      happened: "A motor took more than 5 A for 20 ms: the column pushes against something, or is blocked.",
      steps: [
        "Look for what blocks it: a person, a prop, a cable. Free people first; the drive is released.",
        "Move the column by hand and feel whether it runs freely.",
        "Press Reset with the reason, then Arm.",
      ],
    },
    R6: {
      title: "Following error",
      happened: "The column was more than 5 cm from where it was told to be, for 100 ms.",
      steps: [
        "Look for friction, a loose belt, somebody who held or pushed the column.",
        "Press Reset with the reason.",
        "If it was pushed or the belt slipped: Home. Then Arm.",
      ],
    },
    R7: {
      title: "Implausible motion, failed homing, lost home",
      happened: "The machine moves otherwise than commanded, does not move although commanded, found no switch while homing, or has lost its home. The reason says which.",
      steps: [
        "Read the reason in the banner.",
        "Check motors, encoders, belts and switches, and that nothing blocks the way to the corner.",
        "Press Reset with the reason, then Home. Arm only when homing has succeeded.",
      ],
    },
    R8: {
      title: "Controller link lost",
      happened: "The motor controller gave no good answer for 100 ms. What it was told last is capped in distance, so it stops by itself.",
      steps: [
        "Check the controller’s power and cable.",
        "Wait until rule R8 says that the controller answers.",
        "Press Reset with the reason, then Home, then Arm.",
      ],
    },
    R9: {
      title: "Control loop late",
      happened: "Three steps of the control loop in a row began more than one period late: the computer is busy with something else.",
      steps: [
        "It clears by itself 1 s after the loop keeps its deadlines again.",
        "If it comes back: close other programs, and give the server real-time priority. The strip at the foot says whether it has it.",
      ],
    },
    R10: {
      title: "VR client gone",
      happened: "The connection of the program that sends somebody’s poses is lost while the person is in the arena.",
      steps: [
        "Ask the person to stand still.",
        "Start the VR program again or mend the network. It clears 1 s after the client is back.",
        "If the person has left the arena: look, then press the button that says so beside the name.",
      ],
    },
    R12: {
      title: "Intruder",
      happened: "An input that notices people without a headset is active, or its line is cut or silent. The column brakes and holds, however long that lasts.",
      steps: [
        "Look who is in the arena without a headset, and lead them out.",
        "If nobody is: look at the input named in the reason, its cable and its power.",
        "It goes on by itself 1 s after the input is inactive again. Disarm first if that must not be.",
      ],
    },
    R15: {
      title: "Tracking origin changed",
      happened: "A headset was recentred, found itself elsewhere, or was taken off. Its poses may be right in themselves and wrong in the room.",
      steps: [
        "Ask the person to stand on the floor mark, headset on.",
        "Compare the top view with the room: the person is drawn on the mark.",
        "Press the button beside the name that confirms it. The stop clears 1 s later.",
      ],
    },
    homing: {
      title: "Homing refused, or it waits",
      happened: "Homing is refused while the machine is armed or stopped, and when its way to the corner leads within 0.41 m of a keep-out shape. While somebody tracked is near, it waits.",
      steps: [
        "Read the reason beside the button.",
        "Armed: disarm first. Stopped: reset first.",
        "A keep-out shape in the way: release the drive (Disarm), move the column by hand to a place with a free way to the corner, or activate another scene.",
        "Somebody near: ask them to step away. Homing goes on by itself.",
      ],
    },
    restart: {
      title: "Latched after a restart",
      happened: "The server was ended or has crashed while a stop was latched. The stop is stored, so it is still there; the banner says so, with the old reason.",
      steps: [
        "Treat it as the stop that it was: read the reason and look at the arena.",
        "Press Reset with a reason of your own.",
        "Home, then Arm: after a restart the server does not know the machine’s home.",
      ],
    },
  },
  rulesTitle: "The safety rules",
  rules: {
    R1: {
      watches: "That the column, the way it needs to brake included, stays 2 cm inside its travel.",
      happens: "Near an end it is slowed. More than 1 cm past the end: latched stop.",
      you: "Nothing while it is limiting. After a stop: find out why, and move the column back by hand.",
      clears: "A reset with a reason, once the column is inside its travel.",
    },
    R2: {
      watches: "That everybody in the arena has a tracked headset with a pose no older than 0.5 s.",
      happens: "An older pose makes the column keep more distance; at 0.5 s it is a protective stop.",
      you: "Ask the person to stand still, and look for what hides or slows the headset.",
      clears: "By itself, 1 s after every headset is tracked again.",
    },
    R3: {
      watches: "The separation from every person: the column may only move if it could brake to rest before anybody who walks at 1.6 m/s in any direction comes within 0.35 m of it. Less, 0.25 m, for a slow column near an object that the visitor reaches for; more, 1 m, for somebody low.",
      happens: "It slows, goes around, or holds. This is its daily work and no stop.",
      you: "Nothing. If the column waits too often, give people more room or move the objects apart.",
      clears: "By itself, as soon as there is room again.",
    },
    R4: {
      watches: "The software stop, from every lane: this page, a key, HTTP, a signal.",
      happens: "Latched stop. It also survives a restart of the server.",
      you: "Look why, mend it, reset with a reason, arm.",
      clears: "A reset with a reason.",
    },
    R5: {
      watches: "The current of each motor: no more than 5 A for 20 ms.",
      happens: "Latched stop.",
      you: "Look for what blocks the column.",
      clears: "A reset with a reason, once the current is back.",
    },
    R6: {
      watches: "That the column is where it was told to be, within 5 cm.",
      happens: "Latched stop when it is farther off for 100 ms.",
      you: "Look for friction, slipping belts, or somebody who pushed.",
      clears: "A reset with a reason.",
    },
    R7: {
      watches: "That motion is plausible: it moves as commanded (within 0.35 m/s), does not stall, finds its switches, keeps its home.",
      happens: "Latched stop. A head that jumps faster than 6 m/s is lost tracking instead (R2).",
      you: "Check motors, encoders, belts and switches.",
      clears: "A reset with a reason; then home.",
    },
    R8: {
      watches: "That the motor controller answers at least every 100 ms.",
      happens: "The machine is faulted. The controller stops by itself.",
      you: "Check its power and cable.",
      clears: "A reset with a reason, once it answers again; then home and arm.",
    },
    R9: {
      watches: "That the control loop begins its steps in time.",
      happens: "Three late steps in a row: protective stop.",
      you: "Relieve the computer; give the server real-time priority.",
      clears: "By itself, 1 s after the loop keeps its deadlines again.",
    },
    R10: {
      watches: "That the program behind each person’s headset stays connected.",
      happens: "Protective stop.",
      you: "Start it again, or say that the person has left once you have seen it.",
      clears: "1 s after the client is back, or after you have confirmed that the person left.",
    },
    R11: {
      watches: "That a dashboard of somebody who may arm is connected and answers. By default a real machine asks for one, the simulated one does not (safety.game_master).",
      happens: "Without one, Arm is refused. When the last one goes while the machine is armed, that is shown and recorded; the column goes on.",
      you: "Stay at the desk while the machine is armed; open the dashboard again.",
      clears: "By itself, once such a dashboard is connected.",
    },
    R12: {
      watches: "The inputs that notice people without a headset: a light curtain, a mat, a camera. One that is silent or cut counts as active.",
      happens: "Protective stop. With no such input set up nothing is watched.",
      you: "Look who came in and lead them out. Where there is no such input, keep everybody without a headset out of the arena.",
      clears: "By itself, 1 s after the input is inactive again.",
    },
    R13: {
      watches: "The keep-out shapes of the scene: furniture, places of bystanders. The column keeps 0.35 m and its way to brake from each.",
      happens: "It slows, goes around, or holds.",
      you: "Draw the shapes where things really are, and mend the scene when they move.",
      clears: "By itself.",
    },
    R14: {
      watches: "Contact on purpose, when the column leads, carries or brushes a visitor: only where you armed it for that visitor, no faster than 0.6 m/s (brush 0.3 m/s), gently, and for the time that you gave.",
      happens: "Whoever lets go, steps off or stands in the way makes it brake. Every stop, a lost headset, the end of the time and your page gone end it. Towards everybody else R3 stands as ever.",
      you: "Arm it on the page Scenario when the visitor is ready, and look on. If somebody sits on the column or leans on it while it is stopped, the drive stays on: help them off, then say that nobody leans.",
      clears: "By itself; arm it again.",
    },
    R15: {
      watches: "That nobody’s tracking origin changes unnoticed: a recentre, a jump, a headset taken off.",
      happens: "Protective stop until somebody has confirmed the person on the floor mark.",
      you: "Ask the person onto the mark, compare with the top view, confirm.",
      clears: "1 s after the confirmation.",
    },
    R16: {
      watches: "That the machine does not move by itself while nobody is tracked and nobody has said that the arena is clear.",
      happens: "No motion by itself; homing at creep speed only.",
      you: "Look at the arena before you press Home or Arm: by pressing you say that nobody untracked is in it.",
      clears: "Somebody tracked, or your word by Home or Arm.",
    },
  },
  labels: {
    watches: "What it watches",
    happens: "What happens",
    you: "What you do",
    clears: "What clears it",
    happened: "What happened",
    notWatched: "not watched in this version",
    itsStop: "Its stop, step by step",
    now: "Now:",
    tour: "Show the tour",
    shortcuts: "Show the keyboard shortcuts",
    unknown: (what) => `There is no help called “${what}”.`,
  },
  glossary: {
    title: "Words",
    rows: [
      ["person", "anyone in the arena"],
      ["visitor", "a person with a headset, who is served"],
      ["object", "a virtual object that a visitor may touch"],
      ["prop", "the real thing on the column that stands in for an object"],
      ["column", "what moves through the arena"],
      ["mode", "the state of the machine, in big words at the top"],
      ["scene", "objects, props and keep-out shapes of a room"],
      ["prior", "the scenario’s word on how likely an object is to be touched, from 0 to 1"],
      ["weight", "what the intention rule makes of it for the visitor now"],
      ["command position", "where the column is wanted"],
      ["proxy", "the computed ball that leads the column there smoothly"],
      ["separation", "the distance that the column must keep from a person now"],
    ],
  },
};
