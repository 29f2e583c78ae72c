/** The help in French. Numbers are the defaults of the server's safety parameters. */
import type { HelpText } from "./shape";

/** Plain language, for whoever stands at the desk. */
export const help: HelpText = {
  title: "Aide",
  contents: "Sur cette page",
  first: {
    title: "Premiers pas",
    steps: [
      "Repérez la chaîne d’arrêt câblée et vérifiez qu’elle coupe l’alimentation. Le bouton de cette page ne le fait pas.",
      "Regardez l’arène : personne ne doit s’y trouver sans casque. Le système ne voit pas les spectateurs ; tenez-les à l’écart ou dessinez une zone interdite.",
      "Inscrivez votre nom en haut, pour que l’historique dise qui a changé quoi.",
      "Appuyez sur Origine. La colonne cherche ses fins de course à vitesse très lente.",
      "Appuyez sur Armer. Dès lors, la colonne suit le visiteur et s’efface devant tout le monde.",
      "Gardez un œil sur le mode, en grandes lettres, et sur les règles de sécurité. Pour arrêter : Échap partout, Espace hors saisie, ou le bouton rouge.",
      "Pour finir : Désarmer. La colonne freine, puis les moteurs sont libérés.",
    ],
  },
  softwareStop: {
    title: "Ce qu’est l’arrêt logiciel, et ce qu’il n’est pas",
    paragraphs: [
      "Le bouton rouge, Échap et Espace commandent l’arrêt logiciel. Le serveur freine chaque axe à sa limite, libère les moteurs une fois à l’arrêt et reste verrouillé jusqu’à ce que quelqu’un le réinitialise en donnant une raison. La page indique le temps écoulé ; tant que le serveur n’a pas accusé réception, elle le dit et renvoie l’ordre.",
      "Ce n’est pas un arrêt d’urgence. Il dépend de cet ordinateur, du réseau, du serveur et du contrôleur. La chaîne d’arrêt câblée coupe l’alimentation et ne dépend d’aucun d’eux. Gardez-la à portée de main ; utilisez-la en premier si quelqu’un est en danger, si un arrêt n’est pas confirmé, ou si la machine bouge alors qu’elle ne le devrait pas.",
      "Cette page n’est pas une fonction de sécurité certifiée, le serveur non plus.",
    ],
  },
  kinds: {
    title: "Trois sortes d’arrêt",
    rows: [
      ["Arrêt de protection", "La colonne freine et se maintient. Elle repart d’elle-même quand la cause a disparu depuis 1 s (règles R2, R9, R10, R12, R15)."],
      ["Arrêt verrouillé", "La colonne freine, puis les moteurs sont libérés. Il survit à un redémarrage. Seule une réinitialisation motivée permet d’en sortir, et elle ne met rien en marche : armer est un second geste (R1, R4, R5, R6, R7)."],
      ["En défaut", "On ne peut plus se fier à l’obéissance de la machine ou de sa liaison (R8). On en sort comme d’un arrêt verrouillé ; ensuite, origine puis armement."],
    ],
  },
  stopsTitle: "Les arrêts : ce qui s’est passé, ce qui les lève",
  stops: {
    R4: {
      title: "Arrêt logiciel",
      happened: "Quelqu’un a commandé l’arrêt : sur une page, par une touche, par HTTP ou par un signal au serveur. Le bandeau donne la raison indiquée.",
      steps: [
        "Demandez pourquoi, et regardez l’arène.",
        "Corrigez ce qui n’allait pas. Personne ne s’approche de la colonne avant qu’elle soit désarmée.",
        "Appuyez sur Réinitialiser et écrivez pourquoi c’est sûr. La machine est alors désarmée ; rien ne bouge.",
        "Appuyez sur Armer. Si l’origine est perdue, appuyez d’abord sur Origine.",
      ],
    },
    R1: {
      title: "Hors de la course",
      happened: "La colonne a été mesurée à plus de 1 cm hors de sa course. Les moteurs sont libérés.",
      steps: [
        "Cherchez la cause : courroie qui a glissé, course mal configurée, poussée.",
        "Ramenez la colonne dans sa course à la main.",
        "Réinitialisez en donnant la raison, puis armez. Refaites l’origine si la courroie a glissé.",
      ],
    },
    R2: {
      title: "Suivi perdu",
      happened: "La dernière pose de quelqu’un date de plus de 0,5 s, ou son casque ne connaît plus sa place, ou sa pose a sauté plus vite qu’une tête ne bouge (6 m/s). La colonne freine et se maintient.",
      steps: [
        "Voyez de qui il s’agit : la liste des personnes le dit.",
        "Demandez à la personne de ne plus bouger jusqu’à ce que le casque se retrouve. Cherchez une caméra masquée, un coin sombre, un réseau saturé.",
        "L’arrêt se lève de lui-même 1 s après que tous les casques sont de nouveau suivis.",
        "Si la personne a quitté l’arène : vérifiez de vos yeux, puis appuyez sur le bouton correspondant à côté de son nom.",
      ],
    },
    R5: {
      title: "Courant moteur trop fort",
      happened: "Un moteur a pris plus de 5 A pendant 20 ms : la colonne pousse contre quelque chose ou se trouve bloquée.",
      steps: [
        "Cherchez l’obstacle : une personne, un accessoire, un câble. Dégagez d’abord les personnes ; les moteurs sont libérés.",
        "Déplacez la colonne à la main pour sentir si elle coulisse librement.",
        "Réinitialisez en donnant la raison, puis armez.",
      ],
    },
    R6: {
      title: "Écart de poursuite",
      happened: "La colonne était à plus de 5 cm de la position commandée pendant 100 ms.",
      steps: [
        "Cherchez un frottement, une courroie détendue, quelqu’un qui a retenu ou poussé la colonne.",
        "Réinitialisez en donnant la raison.",
        "Si elle a été poussée ou si la courroie a glissé : Origine. Ensuite, Armer.",
      ],
    },
    R7: {
      title: "Mouvement invraisemblable, origine manquée ou perdue",
      happened: "La machine bouge autrement que commandé, ne bouge pas malgré la commande, n’a trouvé aucune fin de course, ou a perdu son origine. La raison précise lequel.",
      steps: [
        "Lisez la raison dans le bandeau.",
        "Vérifiez moteurs, codeurs, courroies et fins de course, et que rien ne barre le chemin du coin.",
        "Réinitialisez en donnant la raison, puis Origine. N’armez que si la prise d’origine a réussi.",
      ],
    },
    R8: {
      title: "Liaison au contrôleur perdue",
      happened: "Le contrôleur des moteurs n’a donné aucune bonne réponse pendant 100 ms. Son dernier ordre est limité en distance : il s’arrête donc de lui-même.",
      steps: [
        "Vérifiez l’alimentation et le câble du contrôleur.",
        "Attendez que la règle R8 dise que le contrôleur répond.",
        "Réinitialisez en donnant la raison, puis Origine, puis Armer.",
      ],
    },
    R9: {
      title: "Boucle de commande en retard",
      happened: "Trois pas de la boucle de commande à la suite ont commencé avec plus d’une période de retard : l’ordinateur est occupé ailleurs.",
      steps: [
        "L’arrêt se lève de lui-même 1 s après que la boucle tient de nouveau ses échéances.",
        "S’il revient : fermez les autres programmes et donnez au serveur la priorité temps réel. La ligne du bas dit s’il l’a.",
      ],
    },
    R10: {
      title: "Client VR disparu",
      happened: "La connexion du programme qui envoie les poses de quelqu’un est perdue alors que cette personne est dans l’arène.",
      steps: [
        "Demandez à la personne de ne plus bouger.",
        "Relancez le programme VR ou réparez le réseau. L’arrêt se lève 1 s après le retour du client.",
        "Si la personne a quitté l’arène : vérifiez de vos yeux, puis appuyez sur le bouton correspondant à côté de son nom.",
      ],
    },
    R12: {
      title: "Intrus",
      happened: "Une entrée qui remarque les personnes sans casque est active, ou sa ligne est coupée ou muette. La colonne freine et se maintient, aussi longtemps que cela dure.",
      steps: [
        "Voyez qui est dans l’arène sans casque, et raccompagnez-le.",
        "S’il n’y a personne : vérifiez l’entrée nommée dans le motif, son câble et son alimentation.",
        "La colonne repart d’elle-même 1 s après que l’entrée est redevenue inactive. Désarmez d’abord si cela ne doit pas arriver.",
      ],
    },
    R15: {
      title: "Origine du suivi changée",
      happened: "Un casque a été recentré, s’est retrouvé ailleurs ou a été retiré. Ses poses peuvent être justes en elles-mêmes et fausses dans la pièce.",
      steps: [
        "Demandez à la personne de se placer sur la marque au sol, casque sur la tête.",
        "Comparez la vue de dessus avec la pièce : la personne y est dessinée sur la marque.",
        "Appuyez sur le bouton de confirmation à côté de son nom. L’arrêt se lève 1 s plus tard.",
      ],
    },
    homing: {
      title: "Prise d’origine refusée ou en attente",
      happened: "La prise d’origine est refusée quand la machine est armée ou arrêtée, et quand son chemin vers le coin passe à moins de 0,41 m d’une zone interdite. Tant qu’une personne suivie est proche, elle attend.",
      steps: [
        "Lisez la raison à côté du bouton.",
        "Armée : désarmez d’abord. Arrêtée : réinitialisez d’abord.",
        "Zone interdite sur le chemin : libérez les moteurs (Désarmer), amenez la colonne à la main là où le chemin du coin est libre, ou activez une autre scène.",
        "Quelqu’un est proche : demandez-lui de s’écarter. La prise d’origine reprend d’elle-même.",
      ],
    },
    restart: {
      title: "Verrouillée après un redémarrage",
      happened: "Le serveur a été arrêté ou s’est interrompu alors qu’un arrêt était verrouillé. L’arrêt est enregistré, donc toujours là ; le bandeau le dit, avec l’ancienne raison.",
      steps: [
        "Traitez-le comme l’arrêt qu’il était : lisez la raison et regardez l’arène.",
        "Réinitialisez en donnant votre propre raison.",
        "Origine, puis Armer : après un redémarrage, le serveur ne connaît plus l’origine de la machine.",
      ],
    },
  },
  rulesTitle: "Les règles de sécurité",
  rules: {
    R1: {
      watches: "La colonne, distance de freinage comprise, reste à 2 cm à l’intérieur de sa course.",
      happens: "Près d’un bout, elle est ralentie. À plus de 1 cm au-delà : arrêt verrouillé.",
      you: "Rien tant que la règle ne fait que limiter. Après un arrêt : cherchez la cause et ramenez la colonne à la main.",
      clears: "Une réinitialisation motivée, une fois la colonne dans sa course.",
    },
    R2: {
      watches: "Chacun dans l’arène porte un casque suivi, dont la pose a au plus 0,5 s.",
      happens: "Une pose plus vieille fait garder plus de distance ; à 0,5 s, c’est un arrêt de protection.",
      you: "Demandez à la personne de ne plus bouger et cherchez ce qui masque ou ralentit le casque.",
      clears: "D’elle-même, 1 s après que tous les casques sont de nouveau suivis.",
    },
    R3: {
      watches: "La distance à chaque personne : la colonne ne peut bouger que si elle pouvait s’immobiliser avant que quiconque marchant à 1,6 m/s, dans n’importe quelle direction, soit à moins de 0,35 m d’elle. Moins, 0,25 m, pour une colonne lente près d’un objet que le visiteur va toucher ; plus, 1 m, pour quelqu’un de baissé.",
      happens: "Elle ralentit, contourne ou attend. C’est son travail de tous les jours, pas un arrêt.",
      you: "Rien. Si la colonne attend trop souvent, donnez plus de place aux personnes ou écartez les objets.",
      clears: "D’elle-même, dès qu’il y a de nouveau de la place.",
    },
    R4: {
      watches: "L’arrêt logiciel, d’où qu’il vienne : cette page, une touche, HTTP, un signal.",
      happens: "Arrêt verrouillé. Il survit aussi à un redémarrage du serveur.",
      you: "Cherchez pourquoi, corrigez, réinitialisez en donnant une raison, armez.",
      clears: "Une réinitialisation motivée.",
    },
    R5: {
      watches: "Le courant de chaque moteur : pas plus de 5 A pendant 20 ms.",
      happens: "Arrêt verrouillé.",
      you: "Cherchez ce qui bloque la colonne.",
      clears: "Une réinitialisation motivée, une fois le courant revenu.",
    },
    R6: {
      watches: "La colonne est là où on l’a commandée, à 5 cm près.",
      happens: "Arrêt verrouillé si elle en est plus loin pendant 100 ms.",
      you: "Cherchez un frottement, une courroie qui glisse, quelqu’un qui a poussé.",
      clears: "Une réinitialisation motivée.",
    },
    R7: {
      watches: "Le mouvement est vraisemblable : conforme à la commande (à 0,35 m/s près), sans blocage, avec des fins de course trouvées et une origine conservée.",
      happens: "Arrêt verrouillé. Une tête qui saute à plus de 6 m/s compte plutôt comme un suivi perdu (R2).",
      you: "Vérifiez moteurs, codeurs, courroies et fins de course.",
      clears: "Une réinitialisation motivée ; ensuite, la prise d’origine.",
    },
    R8: {
      watches: "Le contrôleur des moteurs répond au moins toutes les 100 ms.",
      happens: "La machine est en défaut. Le contrôleur s’arrête de lui-même.",
      you: "Vérifiez son alimentation et son câble.",
      clears: "Une réinitialisation motivée, quand il répond de nouveau ; ensuite, origine et armement.",
    },
    R9: {
      watches: "La boucle de commande commence ses pas à l’heure.",
      happens: "Trois pas en retard à la suite : arrêt de protection.",
      you: "Déchargez l’ordinateur ; donnez au serveur la priorité temps réel.",
      clears: "D’elle-même, 1 s après que la boucle tient de nouveau ses échéances.",
    },
    R10: {
      watches: "Le programme derrière chaque casque reste connecté.",
      happens: "Arrêt de protection.",
      you: "Relancez-le, ou déclarez que la personne est partie une fois que vous l’avez vu.",
      clears: "1 s après le retour du client, ou après que vous avez confirmé le départ de la personne.",
    },
    R11: {
      watches: "Qu’un tableau de bord de quelqu’un qui peut armer soit connecté et réponde. Par défaut une machine réelle en exige un, la machine simulée non (safety.game_master).",
      happens: "Sans lui, Armer est refusé. Quand le dernier s’en va alors que la machine est armée, c’est affiché et consigné ; la colonne continue.",
      you: "Restez au poste tant que la machine est armée ; rouvrez le tableau de bord.",
      clears: "De lui-même, dès qu’un tel tableau de bord est connecté.",
    },
    R12: {
      watches: "Les entrées qui remarquent les personnes sans casque : barrière lumineuse, tapis, caméra. Une entrée muette ou coupée compte comme active.",
      happens: "Arrêt de protection. Sans une telle entrée, rien n’est surveillé.",
      you: "Voyez qui est entré et raccompagnez-le. Sans une telle entrée, tenez hors de l’arène toute personne sans casque.",
      clears: "D’elle-même, 1 s après que l’entrée est redevenue inactive.",
    },
    R13: {
      watches: "Les zones interdites de la scène : meubles, places de spectateurs. La colonne garde 0,35 m, plus sa distance de freinage, avec chacune.",
      happens: "Elle ralentit, contourne ou attend.",
      you: "Dessinez les zones là où les choses sont vraiment, et corrigez la scène quand elles bougent.",
      clears: "D’elle-même.",
    },
    R14: {
      watches: "Le contact voulu, quand la colonne guide, porte ou effleure un visiteur : seulement si vous l’avez autorisé pour ce visiteur, pas plus vite que 0,6 m/s (effleurer : 0,3 m/s), en douceur, et pour la durée donnée.",
      happens: "Qui lâche, descend ou se tient sur le chemin la fait freiner. Tout arrêt, un casque perdu, la fin du temps et votre page partie y mettent fin. Envers tous les autres, R3 vaut comme toujours.",
      you: "Autorisez-le sur la page Scénario quand le visiteur est prêt, et regardez. Si quelqu’un est assis sur la colonne ou s’y appuie pendant un arrêt, l’entraînement reste sous tension : aidez-le, puis dites que personne ne s’appuie.",
      clears: "De lui-même ; autorisez-le de nouveau.",
    },
    R15: {
      watches: "Aucune origine de suivi ne change sans qu’on le remarque : recentrage, saut, casque retiré.",
      happens: "Arrêt de protection jusqu’à ce que quelqu’un ait confirmé la personne sur la marque au sol.",
      you: "Faites placer la personne sur la marque, comparez avec la vue de dessus, confirmez.",
      clears: "1 s après la confirmation.",
    },
    R16: {
      watches: "La machine ne bouge pas d’elle-même tant que personne n’est suivi et que personne n’a dit que l’arène est vide.",
      happens: "Aucun mouvement spontané ; prise d’origine à vitesse très lente seulement.",
      you: "Regardez l’arène avant d’appuyer sur Origine ou Armer : par ce geste, vous dites que personne sans suivi ne s’y trouve.",
      clears: "Une personne suivie, ou votre parole par Origine ou Armer.",
    },
  },
  labels: {
    watches: "Ce qu’elle surveille",
    happens: "Ce qui arrive",
    you: "Ce que vous faites",
    clears: "Ce qui la lève",
    happened: "Ce qui s’est passé",
    notWatched: "pas encore surveillée dans cette version",
    itsStop: "Son arrêt, pas à pas",
    now: "Maintenant :",
    tour: "Lancer la visite",
    shortcuts: "Afficher les raccourcis clavier",
    unknown: (what) => `Il n’y a pas d’aide nommée « ${what} ».`,
  },
  glossary: {
    title: "Vocabulaire",
    rows: [
      ["personne", "quiconque se trouve dans l’arène"],
      ["visiteur", "une personne avec un casque, que la colonne sert"],
      ["objet", "un objet virtuel qu’un visiteur peut toucher"],
      ["accessoire", "la chose réelle, sur la colonne, qui tient lieu d’objet"],
      ["colonne", "ce qui se déplace dans l’arène"],
      ["mode", "l’état de la machine, en grandes lettres en haut"],
      ["scène", "objets, accessoires et zones interdites d’une pièce"],
      ["a priori", "ce que dit le scénario de la probabilité qu’un objet soit touché, de 0 à 1"],
      ["poids", "ce que la règle d’intention en fait pour le visiteur, maintenant"],
      ["position de consigne", "l’endroit où la colonne est attendue"],
      ["proxy", "la bille calculée qui y mène la colonne en douceur"],
      ["distance requise", "celle que la colonne doit garder avec une personne, maintenant"],
    ],
  },
};
