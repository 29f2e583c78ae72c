/** Motifs : pourquoi une règle est dans cet état, pourquoi la colonne fait ce qu’elle fait, pourquoi une demande a reçu cette réponse. */
import type { CommissioningStep, HardwarePart, MachineTrouble } from "../../api/types";
import { AT_RAD, CENTIMETRES_FOR_METRES, METRES_FOR_CENTIMETRES, refusalSentence, type ReasonSentences, type RefusalSentences } from "../reasons";

/** Ce qui empêche de piloter la machine. */
export const troubles: Record<MachineTrouble, string> = {
  no_port: "le port du contrôleur de moteurs ne s’ouvre pas",
  no_answer: "le contrôleur de moteurs ne répond pas",
  unknown_firmware: "le micrologiciel du contrôleur de moteurs n’est pas connu ici",
  not_configured: "le contrôleur de moteurs ne garde pas un réglage",
  switch_off_and_on: "des réglages du contrôleur de moteurs prennent effet quand son alimentation est coupée puis remise",
  restarted: "le contrôleur de moteurs a redémarré, ou ses comptes ont sauté : la position est perdue",
  emergency_stop: "l’arrêt d’urgence câblé est actif",
  driver_fault: "un pont du contrôleur de moteurs est défectueux",
  too_hot: "le contrôleur de moteurs est trop chaud",
  bad_supply: "une alimentation du contrôleur de moteurs est trop haute ou trop basse",
};

/** Selon l’identifiant envoyé par le serveur. */
/** Ce dont dépend un calibrage. */
export const hardwareParts: Record<HardwarePart, string> = {
  machine: "machine",
  travel: "course",
  controller: "contrôleur de moteurs",
  firmware: "micrologiciel du contrôleur",
  encoders: "nombre d’impulsions par mètre",
  convention: "convention du client",
};

/** Les étapes de la mise en service. */
const commissioningSteps: Record<CommissioningStep, string> = {
  wired_stop: "l’arrêt câblé",
  arena_clear: "le coup d’œil dans l’arène",
  link: "la liaison",
  home: "la prise d’origine",
  directions: "le sens des axes",
  stop_lanes: "l’arrêt logiciel",
  brake: "le frein",
};

/** Why points make no calibration. */
export const refusals: RefusalSentences = {
  too_few_points: ({ found, fewest }) => `${found} points, c’est trop peu : il en faut au moins ${fewest}`,
  too_many_points: ({ found, most }) => `${found} points, c’est plus que les ${most} acceptés`,
  points_too_close: ({ spread_m, least_m }, number) =>
    `les points sont trop proches : ils s’étalent sur ${number(spread_m, 2)} m, il faut au moins ${number(least_m, 2)} m ; utilisez toute l’arène`,
  points_on_a_line: ({ spread_m, least_m }, number) =>
    `les points sont presque alignés : ils s’en écartent de ${number(spread_m, 2)} m, il faut au moins ${number(least_m, 2)} m`,
  wrong_scale: ({ scale, most_off }, number) => {
    const is = `un mètre du casque vaut ${number(scale, 3)} m dans la salle ; `;
    if (scale >= CENTIMETRES_FOR_METRES[0] && scale < CENTIMETRES_FOR_METRES[1]) return `${is}le client semble envoyer des centimètres sous une convention en mètres`;
    if (scale >= METRES_FOR_CENTIMETRES[0] && scale < METRES_FOR_CENTIMETRES[1]) return `${is}le client semble envoyer des mètres sous une convention en centimètres`;
    return `${is}l’écart à 1 est d’au plus ${number(most_off * 100, 0)} % : l’unité du client ou les lieux saisis sont faux`;
  },
  mirrored: () => "les points ne concordent qu’en miroir ou à l’envers : le client déclare une convention dont les axes ne sont pas les siens",
  too_many_outliers: ({ outliers, points, most }) =>
    `${outliers} points sur ${points} contredisent les autres, au plus ${most} sont admis : des lieux ont-ils été confondus ?`,
  poor_fit: ({ rms_m, most_m }, number) =>
    `les points s’écartent de ${number(rms_m * 1e3, 1)} mm en moyenne, il faut au plus ${number(most_m * 1e3, 1)} mm : des lieux ont-ils été confondus, ou le suivi a-t-il sauté ?`,
  tilted: ({ tilt_rad, most_rad }, number) =>
    `la verticale du casque s’écarte de celle de la salle de ${number(degrees(tilt_rad), 1)} degrés, au plus ${number(degrees(most_rad), 1)} sont admis : les hauteurs sont-elles justes ?`,
  uncertain: ({ uncertainty_m, most_m }, number) =>
    `le résultat serait incertain de ${number(uncertainty_m * 1e3, 1)} mm, il faut au plus ${number(most_m * 1e3, 1)} mm : prenez plus de points, plus éloignés`,
  moved: ({ moved_m, most_m }, number) =>
    `il a bougé de ${number(moved_m * 1e3, 1)} mm pendant la mesure, au plus ${number(most_m * 1e3, 1)} mm sont admis : tenez-le immobile ou posez-le`,
  too_few_poses: ({ found, fewest }) => `${found} poses reçues pendant ce temps, il en faut au moins ${fewest} : le casque est-il éveillé ?`,
  not_tracked: () => "le casque n’a pas connu sa position tout du long",
  offset_unknown: ({ found, fewest }) =>
    `on ne sait pas où le casque est posé sur la colonne : saisissez-le, ou touchez au moins ${fewest} lieux avec le même casque (${found} jusqu’ici)`,
  column_moved: ({ moved_m, most_m }, number) =>
    `la colonne a bougé de ${number(moved_m * 1e3, 1)} mm pendant la mesure, au plus ${number(most_m * 1e3, 1)} mm sont admis`,
};

const INTERACTIONS: Readonly<Record<string, string>> = {
  hold: "tenir",
  step_back: "reculer",
  lead: "guider",
  transport: "porter",
  brush: "effleurer",
  park: "s’écarter",
};

const PHASES: Readonly<Record<string, string>> = {
  waiting: "attend",
  holding: "tient",
  stepping_back: "recule",
  leading: "guide",
  riding: "porte",
  approaching: "approche",
  touching: "touche",
  leaving: "s’éloigne",
  parked: "hors de portée",
  done: "terminé",
};

export const reasons: ReasonSentences = {
  nothing_to_watch: () => "rien à surveiller pour l’instant",
  inside_travel: () => "à l’intérieur de la course",
  past_travel: ({ past_m }, { number }) => `la colonne dépasse sa course de ${number(past_m * 100, 1)} cm`,
  travel_end_in_the_way: () => "ralentie en fin de course",
  headsets_tracked: () => "tous les casques sont suivis",
  arena_empty: () => "il n’y a personne dans l’arène",
  no_pose_yet: ({ person, entered_secs }, { number }) => `${person} : entrée il y a ${number(entered_secs, 2)} s, encore aucune pose`,
  pose_too_old: ({ person, age_secs }, { number }) => `${person} : la dernière pose date de ${number(age_secs, 2)} s`,
  headset_untracked: ({ person }) => `${person} : le casque ne sait plus où il est`,
  pose_jumped: ({ person }) => `${person} : la pose a sauté plus vite qu’une tête ne bouge`,
  client_gone: ({ person }) => `${person} : le client VR n’est plus là`,
  headset_off: ({ person }) => `${person} a retiré le casque`,
  origin_unconfirmed: ({ person }) => `${person} doit être confirmé·e sur la marque au sol : l’origine du suivi a changé`,
  nobody_in_the_way: () => "personne sur le chemin",
  person_in_the_way: ({ person, distance_m, required_m }, { number }) =>
    `ralentie ou détournée pour ${person} : ${number(distance_m, 2)} m en chemin, ${number(required_m, 2)} m exigés`,
  no_keep_out_in_the_way: () => "aucune zone interdite sur le chemin",
  keep_out_in_the_way: ({ keep_out, distance_m, required_m }, { number }) =>
    `ralentie ou détournée pour la zone interdite ${keep_out} : ${number(distance_m, 2)} m en chemin, ${number(required_m, 2)} m exigés`,
  stop_not_pressed: () => "pas demandé",
  software_stop: ({ said }) => (said === null ? "arrêt logiciel, sans motif donné" : `arrêt logiciel : ${said}`),
  last_run_latched: ({ rule, because }, { reason }) =>
    ["la dernière exécution a fini par un arrêt verrouillé", rule, because === null ? null : reason(because)].filter((part) => part !== null).join(" : "),
  stop_input: ({ input }) => `l’entrée d’arrêt ${input} est active`,
  input_silent: ({ input }) => `l’entrée ${input} est muette ou illisible, ce qui compte comme active`,
  motor_current: ({ amps, limit_amps }, { number }) => `${number(amps, 1)} A pour une limite de ${number(limit_amps, 1)} A`,
  behind_command: ({ behind_m }, { number }) => `${number(behind_m * 100, 1)} cm de retard sur la commande`,
  astray: () => "pas là où elle était commandée : retenue jusqu’au repos",
  astray_again: ({ times }) => `pas là où elle était commandée, ${times} fois de suite`,
  moves_as_commanded: () => "bouge comme commandé",
  moves_otherwise: ({ difference_mps }, { number }) => `la vitesse s’écarte de ${number(difference_mps, 2)} m/s de la commande`,
  does_not_move: () => "commandée, mais ne bouge pas",
  no_switch_found: () => "la prise d’origine n’a trouvé aucune fin de course",
  home_lost: () => "la machine a perdu son origine",
  no_answer_yet: () => "la machine n’a pas encore répondu",
  machine_trouble: ({ trouble }) => troubles[trouble],
  no_good_answer: ({ silent_millis }) => `aucune réponse valable depuis ${silent_millis} ms`,
  controller_answers: () => "le contrôleur répond",
  steps_in_time: () => "les pas de commande commencent à l’heure",
  steps_late: ({ steps }) => `${steps} pas de commande de suite ont commencé en retard`,
  game_master_not_needed: () => "cette machine s’arme aussi sans tableau de bord de maître du jeu",
  game_master_present: () => "le tableau de bord d’un maître du jeu est connecté",
  game_master_absent: () => "aucun tableau de bord de maître du jeu n’est connecté, et il en faut un pour armer",
  no_intruder_input: () => "aucune entrée de détection d’intrus n’est configurée",
  no_intruder: () => "pas d’intrus",
  intruder: ({ input }) => `l’entrée ${input} signale quelqu’un que personne ne suit`,
  arena_accounted_for: () => "les personnes sont suivies, ou l’arène a été confirmée vide",
  arena_unconfirmed: () => "personne n’est suivi et personne n’a confirmé que l’arène est vide : aucun mouvement spontané",
  calibration_outdated: ({ client, version, part, was, is }) =>
    `le calibrage ${version} de ${client} a été fait sur un autre matériel (${hardwareParts[part]} : ${was} alors, ${is} maintenant) ; refaites-le`,
  bad_calibration: ({ refusal }, { number }) => refusalSentence(refusals, refusal, number),
  interaction_goes_on: ({ interaction, object }, { object: label }) => `l’interaction ${interaction} à ${label(object)} est en cours : pas d’autre scène avant sa fin, ou avant de désarmer la machine`,
  touch_goes_on: ({ person, object }, { object: label }) => `${person} touche ${label(object)}, et la machine est armée : pas d’autre scène avant que la main soit partie, ou la machine désarmée`,
  not_while_it_moves: () => "pas tant que la machine est armée, prend son origine ou est déplacée à la main",
  no_calibration_draft: () => "aucun calibrage n’est en cours : commencez-en un",
  no_calibration_point: ({ point }) => `le calibrage en cours n’a pas de point ${point}`,
  point_being_taken: () => "un autre point est en cours de mesure : attendez",
  client_not_there: ({ client }) => `aucun client ${client} n’est connecté seul avec au plus une personne`,
  no_pointer: ({ client }) => `le client ${client} n’envoie pas la position de cette main`,
  client_not_calibrated: ({ client }) => `le client ${client} n’a pas de calibrage en vigueur : calibrez d’abord sa salle`,
  no_prop: ({ prop }) => `la scène active n’a pas d’accessoire ${prop}`,
  no_calibration: ({ calibration }) => `il n’y a pas de calibrage ${calibration}`,
  asked: ({ request }, say) => say.request(request),
  reset_asked: ({ said }) => `réinitialisation : ${said}`,
  homing_done: () => "origine prise",
  protective_stop_over: () => "la cause de l’arrêt de protection a disparu",
  now_in: ({ mode }, say) => `état : ${say.mode(mode)}`,
  stopped: () => "arrêtée",
  stopped_already: () => "déjà arrêtée ; l’arrêt est verrouillé",
  homing_already: () => "prise d’origine déjà en cours",
  disarm_first: () => "la machine est armée : désarmez d’abord",
  reset_first: () => "la machine est arrêtée : réinitialisez d’abord",
  home_first: () => "pas d’origine : prenez d’abord l’origine",
  wait_for_homing: () => "prise d’origine : attendez qu’elle soit finie",
  wait_for_rest: () => "la colonne bouge encore : attendez qu’elle soit au repos",
  armed_already: () => "déjà armée",
  armed_in_protective_stop: () => "déjà armée ; l’arrêt de protection se lève tout seul",
  disarmed_already: () => "déjà désarmée",
  released_already: () => "les moteurs sont déjà libérés ; quittez l’arrêt par une réinitialisation",
  cause_still_there: ({ rule, because }, { reason }) => `la cause est encore là : ${rule} : ${reason(because)}`,
  clears_by_itself: () => "un arrêt de protection se lève tout seul quand sa cause a disparu",
  nothing_to_reset: () => "rien à réinitialiser",
  reset_needs_reason: () => "une réinitialisation demande un motif",
  homing_near_keep_out: ({ keep_out, required_m }, { number }) =>
    `la prise d’origine passerait à moins de ${number(required_m, 2)} m de la zone interdite ${keep_out}`,
  person_not_inside: ({ person }) => `${person} n’est pas dans l’arène`,
  origin_confirmed_already: ({ person }) => `${person} : déjà confirmé·e sur la marque au sol`,
  origin_confirmed: ({ person }) => `${person} : confirmé·e sur la marque au sol`,
  person_still_tracked: ({ person }) => `${person} : le casque est suivi, donc dans l’arène`,
  person_left: ({ person }) => `${person} est sorti·e`,
  no_such_object: ({ index, objects }) => `objet ${index} sur ${objects} objets`,
  prior_out_of_range: ({ index, prior }, { number }) => `a priori ${number(prior, 2)} de l’objet ${index} : attendu de 0 à 1`,
  priors_set: ({ count }) => (count < 2 ? `${count} a priori réglé` : `${count} a priori réglés`),
  column_in_keep_out: ({ keep_out, required_m }, { number }) =>
    `la colonne est à moins de ${number(required_m, 2)} m de la zone interdite ${keep_out} : éloignez-la d’abord`,
  scene_activated: () => "la scène est active",
  no_scenario: () => "la scène active n’a pas de scénario",
  scenario_stands: () => "le scénario est arrêté : il se déroule quand la machine suit les personnes",
  no_such_cue: ({ cue, known }) =>
    known.length === 0 ? `il n’y a pas de signal ${cue} : ce scénario n’en a aucun` : `il n’y a pas de signal ${cue} dans ce scénario ; il connaît ${known.join(", ")}`,
  not_awaited: ({ name, state }) => `rien n’attend ${name} dans l’état ${state} maintenant`,
  no_such_state: ({ state }) => `il n’y a pas d’état ${state} dans ce scénario`,
  nothing_before: () => "c’est le premier état de la partie : il n’y a rien où revenir",
  now_in_state: ({ state }) => `le scénario est dans l’état ${state}`,
  interacts: ({ interaction, phase, object, person }, { object: label }) =>
    `${INTERACTIONS[interaction] ?? interaction}, ${label(object)} : ${PHASES[phase] ?? phase}${person === null ? "" : `, ${person}`}`,
  contact_not_armed: () => "aucun contact n’est autorisé",
  contact_armed: ({ person }) => `autorisé pour ${person} : une colonne en mouvement peut toucher cette personne, dans ses limites`,
  in_contact: ({ person, interaction }) => `en contact avec ${person} : ${INTERACTIONS[interaction] ?? interaction}`,
  no_contact_interaction: () => "la scène active n’a pas d’interaction où une colonne en mouvement touche quelqu’un",
  contact_secs: ({ least, most }, { number }) => `un contact s’autorise pour ${number(least, 0)} à ${number(most, 0)} s`,
  contact_for_another: ({ person }) => `autorisé pour ${person} à la place`,
  contact_taken_back: () => "retiré",
  contact_time_over: () => "son temps est écoulé",
  person_not_tracked: ({ person }) => `le casque de ${person} n’est pas suivi`,
  interaction_let_go: () => "lâché",
  stepped_off: () => "n’est plus sur le siège",
  another_is_meant: () => "un autre objet est visé",
  state_left: () => "le scénario a continué",
  interaction_stopped: ({ mode }, say) => `maintenant : ${say.mode(mode)}`,
  nobody_leans: () => "personne ne s’appuie sur la colonne ni n’est dessus, quelqu’un a regardé",
  skip_needs_reason: () => "sauter ou revenir demande une raison",
  busy: () => "occupé : la file de la boucle de commande est pleine ; réessayez",
  control_not_running: () => "la boucle de commande ne tourne pas",
  drive_silent: ({ within_millis }) => `aucun accusé de réception du variateur en ${within_millis} ms ; utilisez l’arrêt câblé`,
  database_silent: () => "la base de données n’a pas répondu ; le journal du serveur dit pourquoi",
  preview_unfinished: () => "l’aperçu n’a pas été terminé",
  no_scene: ({ scene }) => `il n’y a pas de scène ${scene}`,
  no_scene_version: ({ scene, version }) => `il n’y a pas de version ${version} de la scène ${scene}`,
  no_session: ({ session }) => `il n’y a pas de séance « ${session} »`,
  drive_released: () => "les moteurs sont libérés",
  looks_for_switches: () => "cherche ses fins de course au ralenti",
  holds_unarmed: () => "origine prise, à l’arrêt ; ne suit personne tant qu’elle n’est pas armée",
  stopped_by: ({ rule }) => `arrêtée par ${rule}`,
  waits_for_pose: ({ person }) => `attend la première pose (${person})`,
  no_headset_tracked: () => "aucun casque n’est suivi",
  every_prior_zero: () => "aucun objet actif n’a de poids : tous les a priori sont à 0",
  serves: ({ person, object, weight }, { number, object: label }) =>
    `${person === null ? "" : `pour ${person}, `}${label(object)} : poids ${number(weight, 2)}`,
  next_in_line: ({ object, weight }, { number, object: label }) => `ensuite ${label(object)} ${number(weight, 2)}`,
  undecided: ({ person, object, weight, other, other_weight }, { number, object: label }) =>
    `${person === null ? "" : `pour ${person}, `}hésite entre ${label(object)} ${number(weight, 2)} et ${label(other)} ${number(other_weight, 2)}`,
  not_commissioned: () => "cette machine n’a pas été mise en service : lancez covr commission, qui mesure son frein",
  commissioning_outdated: ({ part, was, is }) => `cette machine a été mise en service autre qu’elle n’est (${hardwareParts[part]} : ${was} alors, ${is} maintenant) ; relancez covr commission`,
  commissioning_unfinished: ({ step }) => `la mise en service n’est pas finie : il manque ${commissioningSteps[step]}`,
  no_brake_run: ({ axis, positive, needed_mps }, { number }) =>
    `aucun arrêt depuis ${number(needed_mps, 2)} m/s n’a été mesuré en ${positive ? "s’éloignant" : "s’approchant"} de l’origine le long de ${axis}`,
  brakes_worse: ({ axis, measured_mps2, needed_mps2 }, { number }) =>
    `le long de ${axis} le frein fait ${number(measured_mps2, 2)} m/s2, et ses limites disent ${number(needed_mps2, 2)} m/s2`,
  brakes_longer: ({ axis, distance_m, allowed_m }, { number }) =>
    `le long de ${axis} un arrêt a pris ${number(distance_m, 3)} m, pour ${number(allowed_m, 3)} m prévus`,
  person_inside: ({ person }) => `${person} est dans l’arène`,
  arena_confirmed_clear: () => "l’arène est vide, quelqu’un a regardé",
  jogs_while_held: () => "se déplace à la main tant que le bouton est maintenu",
  no_jog_order: ({ fastest_mps }, { number }) =>
    `il faut une direction ou un endroit, et une vitesse positive d’au plus ${number(fastest_mps, 2)} m/s`,
  jog_outside_travel: () => "cet endroit est hors de la course",
  jog_let_go: () => "relâchée",
  jog_silent: () => "le bouton ne s’est plus annoncé",
  jog_not_yet: () => "pas encore : une règle a demandé un arrêt il y a moins d’une seconde, ou la machine vient d’être prête",
  jog_over: ({ mode }, say) => `maintenant ${say.mode(mode)}`,
  jog_held_by: ({ author }) => `${author} déplace la colonne en ce moment`,
  no_object: () => "aucun objet",
  to_go: ({ left_m, speed_mps }, { number }) => `encore ${number(left_m, 2)} m à ${number(speed_mps, 2)} m/s`,
  held_short: ({ left_m }, { number }) => `retenue à ${number(left_m, 2)} m du but`,
  goes_around: () => "contourne quelqu’un sur le chemin",
  stands_there: () => "en place",
  looks_at: ({ person, object, angle_rad, distance_m }, { number, object: label }) =>
    `${person} regarde ${angle_rad < AT_RAD ? "" : `à ${number((angle_rad * 180) / Math.PI, 0)}° de `}${label(object)}, à ${number(distance_m, 2)} m`,
  none_plain: ({ person, probability }, { number }) => `sans doute aucun d’eux (${number(probability * 100, 0)} %) : ${person} regarde autour`,
  at_object: ({ object, probability }, { number, object: label }) => `à ${label(object)}, le plus probable (${number(probability * 100, 0)} %)`,
  at_another: ({ object }, { object: label }) => `à ${label(object)} : de là, davantage est atteint à temps`,
  between: ({ object, other }, { object: label }) => `entre ${label(object)} et ${label(other)} : de là, l’un ou l’autre est atteint à temps`,
  at_mean: () => "la moyenne des places des objets, pondérée par la croyance",
  among_objects: () => "au milieu de plusieurs objets : de là, la plupart sont atteints à temps",
  straight_on: () => "tout droit, personne sur le chemin",
  at_its_limits: () => "aussi tôt que ses limites le permettent",
  people_cost: ({ secs }, { number }) => `des personnes sur le chemin et un départ doux coûtent ${number(secs, 1)} s`,
  not_foreseen: () => "plus tard que son plan ne va",
  real_time_not_asked: () => "ordonnancement normal, mémoire non verrouillée (control.real_time vaut false)",
  real_time: ({ priority }) => `SCHED_FIFO, priorité ${priority}`,
  real_time_refused: ({ said }) => `ordonnancement normal (SCHED_FIFO refusé : ${said})`,
  memory_locked: () => "mémoire verrouillée",
  memory_locked_for_now: () => "mémoire présente verrouillée, à venir non (RLIMIT_MEMLOCK est limité)",
  memory_not_locked: ({ said }) => `mémoire non verrouillée (${said})`,
};

function degrees(rad: number): number {
  return (rad * 180) / Math.PI;
}
