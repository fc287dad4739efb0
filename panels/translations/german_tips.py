"""German: tooltips of operators, looks and settings."""

_OPERATORS = {
    "Take the Seeds tool: a click on the scan, in its image or on its mesh, places a seed in the tool's color": (
        "Das Saatpunkt-Werkzeug nehmen: Ein Klick auf den Scan, im Bild oder auf dem Netz, setzt einen Saatpunkt in "
        "der Farbe des Werkzeugs"
    ),
    "Take seeds, spread evenly, from the colors that came with the scan; hand-picked and locked ones stay": (
        "Gleichmäßig verteilte Saatpunkte aus den Farben nehmen, die mit dem Scan kamen; von Hand gesetzte und "
        "gesperrte bleiben"
    ),
    "Import the scan that comes with the extension, and the photo that goes with it, to try everything on": (
        "Den Scan importieren, der mit der Erweiterung kommt, und das Foto dazu, um alles daran auszuprobieren"
    ),
    "Show what was found when the selected photo was matched with this scan": (
        "Zeigen, was gefunden wurde, als das gewählte Foto diesem Scan zugeordnet wurde"
    ),
    "Disable and enable Reflectance Colorizer: then Blender puts back what another extension took away": (
        "Reflectance Colorizer aus- und einschalten: dann setzt Blender wieder ein, was eine andere Erweiterung nahm"
    ),
    "Delete the selected seeds; where none is selected, nothing, lest the scan itself be deleted": (
        "Die ausgewählten Saatpunkte löschen; ist keiner ausgewählt, nichts, damit nicht der Scan gelöscht wird"
    ),
    "Have renders show the scans only, through a camera that has the whole scan in its picture; F12 renders": (
        "Gerenderte Bilder zeigen nur die Scans, durch eine Kamera, die den ganzen Scan im Bild hat; F12 rendert"
    ),
    "Let go of the picked color or, if there is none, leave the preview of Live Update": (
        "Die aufgenommene Farbe fallen lassen oder, wenn keine da ist, die Vorschau verlassen"
    ),
    "Add a pixel of the scan whose color is known, given directly or by a point of a photo": (
        "Ein Pixel des Scans hinzufügen, dessen Farbe bekannt ist: unmittelbar oder durch einen Punkt eines Fotos"
    ),
    "Choose what the viewports show of the scan; only reflectance and colorized change renders and exports, too": (
        "Wählen, was die Ansichten vom Scan zeigen; nur Reflektanz und Eingefärbt ändern auch Bilder und Exporte"
    ),
    "Click in the reflectance image to place a seed, in a photo to pick its color, on a seed to select it": (
        "Ein Klick ins Reflektanzbild setzt einen Saatpunkt, ins Foto nimmt seine Farbe auf, auf einen wählt ihn aus"
    ),
    "Click on the mesh to place a seed at the vertex there, on a seed to select it": (
        "Ein Klick aufs Netz setzt einen Saatpunkt an den Vertex dort, auf einen Saatpunkt wählt ihn aus"
    ),
    "Click to select the seed and show it": "Ein Klick wählt den Saatpunkt aus und zeigt ihn",
    "Compare the colors with those of the scan itself or of an image, and store the difference at every vertex": (
        "Die Farben mit denen des Scans oder eines Bildes vergleichen und den Unterschied an jedem Vertex ablegen"
    ),
    "Copy the whole message to the clipboard": "Die ganze Meldung in die Zwischenablage kopieren",
    "Copy the whole report on the scan's colors, as JSON, to the clipboard": (
        "Den ganzen Bericht über die Farben des Scans als JSON in die Zwischenablage kopieren"
    ),
    "Delete the selected seeds": "Die ausgewählten Saatpunkte löschen",
    "Move the seed that is dragged, with all that are selected if it is, or lay a line of seeds where there is none": (
        "Den gezogenen Saatpunkt versetzen, mit allen ausgewählten, wenn er es ist; wo keiner ist, eine Linie legen"
    ),
    "Find seeds of the selected scans in the photos; hand-picked and locked ones stay, four to six pairs help": (
        "Saatpunkte der ausgewählten Scans in den Fotos suchen; gesetzte und gesperrte bleiben, vier bis sechs Paare "
        "helfen"
    ),
    "Go back to the workspace that was there before, and remove this one": (
        "Zum Arbeitsbereich von vorher zurückkehren und diesen entfernen"
    ),
    "Have the selected seeds, or those that are placed next, keep the scan gray around them": (
        "Die ausgewählten oder die nächsten Saatpunkte den Scan um sich herum grau lassen"
    ),
    "Import a structured laser scan (E57, PTX, PCD and others, or a range and a reflectance image) as a mesh": (
        "Einen strukturierten Laserscan (E57, PTX, PCD und andere oder ein Entfernungs- und ein Reflektanzbild) als "
        "Netz importieren"
    ),
    "Keep the selected seeds when the photos are matched again": (
        "Die ausgewählten Saatpunkte behalten, wenn die Fotos noch einmal zugeordnet werden"
    ),
    "Keep the settings of the colorization as a preset, or remove a preset": (
        "Die Einstellungen des Einfärbens als Vorlage behalten, oder eine Vorlage entfernen"
    ),
    "Keep the settings of the search in photos as a preset, or remove a preset": (
        "Die Einstellungen der Suche in Fotos als Vorlage behalten, oder eine Vorlage entfernen"
    ),
    "Lay out the reflectance image, a photo and the mesh side by side, in a workspace of its own": (
        "Reflektanzbild, Foto und Netz nebeneinander zeigen, in einem eigenen Arbeitsbereich"
    ),
    "Let go of the picked color; the next seed waits for its own": (
        "Die aufgenommene Farbe loslassen; der nächste Saatpunkt wartet auf seine eigene"
    ),
    "Load ordinary photos, or those inside an E57, from any camera and any place, to take colors from": (
        "Gewöhnliche Fotos oder die in einer E57-Datei laden, von irgendeiner Kamera und irgendwo her, um Farben "
        "daraus zu nehmen"
    ),
    "Load seeds for the scan from a JSON file": "Saatpunkte für den Scan aus einer JSON-Datei laden",
    "Move a seed to another pixel of the scan; its color stays": (
        "Einen Saatpunkt auf ein anderes Pixel des Scans versetzen; seine Farbe bleibt"
    ),
    "Pick a color in a photo, for the selected seeds or, if none is, for those that are placed next": (
        "Eine Farbe im Foto aufnehmen, für die ausgewählten Saatpunkte oder, ist keiner es, für die nächsten"
    ),
    "Place a seed; it has the picked color, or is given one by the next click in a photo": (
        "Einen Saatpunkt setzen; er hat die aufgenommene Farbe, oder der nächste Klick ins Foto gibt ihm eine"
    ),
    "Place seeds in the reflectance image and pick their colors in a photo, in either order.\n"
    "Click: place, pick or select.  Drag a seed: move it.  Drag elsewhere: lay a line of seeds.\n"
    "Ctrl-click: delete.  Alt-click: take a color.  Shift-drag: select in a box.  Ctrl-drag: select by a lasso": (
        "Saatpunkte ins Reflektanzbild setzen und ihre Farben im Foto aufnehmen, in beliebiger Reihenfolge.\n"
        "Klick: setzen, aufnehmen oder auswählen.  Saatpunkt ziehen: versetzen.  Anderswo ziehen: eine Linie legen.\n"
        "Strg-Klick: löschen.  Alt-Klick: Farbe nehmen.  Umschalt-Ziehen: Rechteck.  Strg-Ziehen: Lasso"
    ),
    "Place seeds on the mesh of a scan.\nClick: place or select.  Ctrl-click: delete.  X: delete the selected ones": (
        "Saatpunkte auf das Netz eines Scans setzen.\n"
        "Klick: setzen oder auswählen.  Strg-Klick: löschen.  X: ausgewählte löschen"
    ),
    "Remove a seed of the scan": "Einen Saatpunkt des Scans entfernen",
    "Remove all seeds of the scan, and the colors that photos saw of it": (
        "Alle Saatpunkte des Scans entfernen, und die Farben, die Fotos von ihm gesehen haben"
    ),
    "Save the seeds of the scan as a JSON file, for the command line or another scan of the same place": (
        "Die Saatpunkte als JSON-Datei speichern, für die Kommandozeile oder einen anderen Scan desselben Ortes"
    ),
    "Scan the scene with a virtual laser scanner and take photos of it, for teaching, planning and tests": (
        "Die Szene mit einem virtuellen Laserscanner scannen und fotografieren, für Lehre, Planung und Tests"
    ),
    "Select a seed; the next click in a photo gives it its color": (
        "Einen Saatpunkt auswählen; der nächste Klick in ein Foto gibt ihm seine Farbe"
    ),
    "Select all seeds, none, or those of one kind": "Alle Saatpunkte auswählen, keinen, oder die von einer Art",
    "Select the seed that the message is about and show it in the images; without one, show the whole message": (
        "Den Saatpunkt, von dem die Meldung handelt, auswählen und in den Bildern zeigen; ohne einen die ganze Meldung"
    ),
    "Select the seeds inside a box or a lasso that is drawn around them": (
        "Die Saatpunkte auswählen, um die ein Rechteck oder ein Lasso gezogen wird"
    ),
    "Set alpha, beta and the other settings of the colorization to a preset": (
        "Alpha, Beta und die anderen Einstellungen des Einfärbens auf eine Vorgabe setzen"
    ),
    "Show the scan's reflectance in an Image Editor of this window, or in a new window if it has none": (
        "Die Reflektanz des Scans in einem Bildeditor dieses Fensters zeigen, oder, hat es keinen, in einem neuen"
    ),
    "Show the whole message, to read and to copy": "Die ganze Meldung zeigen, zum Lesen und Kopieren",
    "Spread the colors of each selected scan's seeds over all of it, along paths of like reflectance and range": (
        "Die Farben der Saatpunkte jedes ausgewählten Scans über ihn verbreiten, auf Wegen gleicher Reflektanz und "
        "Entfernung"
    ),
    "Take the selected photo off the list; the image stays in the file": (
        "Das ausgewählte Foto von der Liste nehmen; das Bild bleibt in der Datei"
    ),
    "Turn Live Update off, and show the colors that were there before": (
        "Die Live-Aktualisierung ausschalten und die Farben von vorher zeigen"
    ),
}

_EXPORT = {
    "Every return once, in the order of the scan's grid: for CloudCompare, MeshLab and scripts": (
        "Jede Messung einmal, in der Reihenfolge des Scanrasters: für CloudCompare, MeshLab und Skripte"
    ),
    "The scanned file with colors, if it is one: for CloudCompare, ReCap and Cyclone": (
        "Die gescannte Datei mit Farben, wenn sie eine ist: für CloudCompare, ReCap und Cyclone"
    ),
    "The scanned file with colors, if it is one: for Cyclone and CloudCompare": (
        "Die gescannte Datei mit Farben, wenn sie eine ist: für Cyclone und CloudCompare"
    ),
    "For film and visual effects": "Für Film und visuelle Effekte",
    "For viewers on the web and game engines": "Für Betrachter im Web und Spiele-Engines",
    "What to write; a suffix that is typed decides otherwise": (
        "Was geschrieben wird; eine getippte Endung entscheidet anders"
    ),
    "Write the selected scans with the colors that renders show, exactly as they are": (
        "Die ausgewählten Scans mit den Farben schreiben, die Bilder zeigen, genau wie sie sind"
    ),
}

_LOOKS = {
    "How far to trust each color: 1 at the seeds, falling with the distance from them": (
        "Wie weit jeder Farbe zu trauen ist: 1 an den Saatpunkten, fallend mit dem Abstand von ihnen"
    ),
    "The colors that came with the scan": "Die Farben, die mit dem Scan kamen",
    "The colors that were spread from the seeds": "Die Farben, die von den Saatpunkten aus verbreitet wurden",
    "The colors that were spread from the seeds; renders and exports take them, too": (
        "Die von den Saatpunkten verbreiteten Farben; auch Bilder und Exporte nehmen sie"
    ),
    "The difference from the true colors, where they are known, in CIEDE2000": (
        "Der Unterschied zu den wahren Farben, wo sie bekannt sind, in CIEDE2000"
    ),
    "The distance from the scanner": "Der Abstand vom Scanner",
    "The gray of the reflectance, as the scanner measured it; renders and exports take it, too": (
        "Das Grau der Reflektanz, wie der Scanner sie maß; auch Bilder und Exporte nehmen es"
    ),
    "The regions that are nearest to each seed, in a color of their own that is not the seed's": (
        "Die Gebiete, die jedem Saatpunkt am nächsten sind, in eigener Farbe, die nicht die des Saatpunkts ist"
    ),
    "What to look at": "Was zu sehen ist",
}

_SETTINGS = {
    "Above 1 the colors are lighter, below 1 darker, whatever the light comes from; 1 changes nothing": (
        "Über 1 sind die Farben heller, unter 1 dunkler, woher auch immer das Licht kommt; 1 ändert nichts"
    ),
    "Whether the photo's camera was found and confirmed": "Ob die Kamera des Fotos gefunden und bestätigt wurde",
    "All seeds where that takes about two seconds, else as many as it takes to be close to that": (
        "Alle Saatpunkte, wo das etwa zwei Sekunden braucht, sonst so viele, dass es dem nahekommt"
    ),
    "By each photo's camera, accepted only if it passes a test": (
        "Nach der Kamera jedes Fotos, die nur gilt, wenn sie eine Prüfung besteht"
    ),
    "By the most similar superpixels, as published; often wrong on real scans": (
        "Nach den ähnlichsten Superpixeln, wie veröffentlicht; bei echten Scans oft falsch"
    ),
    "Cells of a block of the descriptor": "Zellen eines Blocks des Deskriptors",
    "Colors exactly as they are, without any light": "Farben genau, wie sie sind, ohne jedes Licht",
    "Directions that the descriptor tells apart": "Richtungen, die der Deskriptor unterscheidet",
    "Every seed colors every pixel, as the paper has it": "Jeder Saatpunkt färbt jedes Pixel, wie veröffentlicht",
    "Where light and dark come from: 0 the reflectance, which has no shadows; 1 the photo and picked colors": (
        "Woher Hell und Dunkel kommen: 0 von der Reflektanz, die keine Schatten hat; 1 vom Foto und gewählten Farben"
    ),
    "Fill small holes and smooth outlines in pictures; the scan's mesh stays as it was measured": (
        "In Bildern kleine Löcher füllen und Umrisse glätten; das Netz des Scans bleibt, wie es gemessen wurde"
    ),
    "The photo's own colors where a verified one saw the scan; elsewhere as Enhanced, and as light as the photo": (
        "Die eigenen Farben des Fotos, wo ein bestätigtes den Scan sah; sonst wie Verbessert, und so hell wie das Foto"
    ),
    "Take the color of every pixel that a verified photo saw from the photo; else from seeds alone": (
        "Die Farbe jedes Pixels, das ein bestätigtes Foto sah, vom Foto nehmen; sonst allein von den Saatpunkten"
    ),
    "Where a color is one that a verified photo saw there, 1, and where it is inferred from others, 0": (
        "Wo eine Farbe die ist, die ein bestätigtes Foto dort sah, 1, und wo sie aus anderen erschlossen ist, 0"
    ),
    "Make an image with the detail of the photos, and show it on the scan instead of the colors of its vertices": (
        "Ein Bild mit den Einzelheiten der Fotos erzeugen und auf dem Scan statt der Farben seiner Punkte zeigen"
    ),
    "Make a copy of the scan with few faces, whose colors are an image, and hide the scan itself": (
        "Eine Kopie des Scans mit wenigen Flächen erzeugen, deren Farben ein Bild sind, und den Scan selbst ausblenden"
    ),
    "How many triangles the copy has at most": "Wie viele Dreiecke die Kopie höchstens hat",
    "Pixels along the longer side of the image": "Pixel entlang der längeren Seite des Bildes",
    "The colors with the detail of the photos": "Die Farben mit den Einzelheiten der Fotos",
    "Which photo saw each color, in a color of its own that is not the photo's; gray where none did": (
        "Welches Foto jede Farbe sah, in einer eigenen Farbe, die nicht die des Fotos ist; grau, wo keines"
    ),
    "How fast a seed's influence falls with the geodesic distance; higher makes borders sharper": (
        "Wie schnell der Einfluss eines Saatpunkts mit der geodätischen Entfernung fällt; höher macht Grenzen schärfer"
    ),
    "How many of its nearest seeds color a pixel": ("Wie viele seiner nächsten Saatpunkte ein Pixel färben"),
    "How pictures of the scans look": "Wie Bilder der Scans aussehen",
    "How seeds are found in photos": "Wie Saatpunkte in Fotos gefunden werden",
    "How square superpixels are; less lets them follow edges": (
        "Wie quadratisch Superpixel sind; weniger lässt sie Kanten folgen"
    ),
    "How strongly steps in range hold colors back; 0 looks at the reflectance alone (Yatziv)": (
        "Wie stark Sprünge der Entfernung Farben aufhalten; 0 sieht nur auf die Reflektanz (Yatziv)"
    ),
    "In even light, which shows the shape of surfaces": "In gleichmäßigem Licht, das die Form der Flächen zeigt",
    "Leave out of pictures where the beam met two surfaces, and measured between them": (
        "In Bildern weglassen, was der Strahl zwischen zwei Flächen gemessen hat, die er beide traf"
    ),
    "Logarithms of cone responses, decorrelated over natural images": (
        "Logarithmen der Zapfenantworten, dekorreliert über natürliche Bilder"
    ),
    "Luminance and two color differences, ITU-R BT.601; the paper's choice": (
        "Helligkeit und zwei Farbdifferenzen, ITU-R BT.601; die Wahl der Veröffentlichung"
    ),
    "Luminance and two color differences, as in analog television": (
        "Helligkeit und zwei Farbdifferenzen, wie im analogen Fernsehen"
    ),
    "Only a pixel's nearest seeds color it; quick with very many seeds": (
        "Nur seine nächsten Saatpunkte färben ein Pixel; schnell bei sehr vielen Saatpunkten"
    ),
    "Paths step diagonally too": "Wege gehen auch schräg",
    "Paths step to the pixels above, below, left and right": "Wege gehen zu den Pixeln oben, unten, links und rechts",
    "Perceptual lightness and two opponent colors": "Wahrgenommene Helligkeit und zwei Gegenfarben",
    "Pixels by which the image is smoothed before it is divided": (
        "Pixel, um die das Bild geglättet wird, bevor es geteilt wird"
    ),
    "Pixels by which the reflectance is smoothed before distances are measured on it; not in the paper": (
        "Pixel, um die die Reflektanz geglättet wird, bevor Wege darauf gemessen werden; nicht in der Veröffentlichung"
    ),
    "Pixels of a cell of the descriptor": "Pixel einer Zelle des Deskriptors",
    "Pixels of the descriptor's window around a superpixel's center": (
        "Pixel des Fensters des Deskriptors um die Mitte eines Superpixels"
    ),
    "Share of a statistical estimate from position, surface and reflectance; not in the paper": (
        "Anteil einer statistischen Schätzung aus Ort, Oberfläche und Reflektanz; nicht in der Veröffentlichung"
    ),
    "Superpixels that the scan, and each photo, is divided into; there is one seed in each at most": (
        "Superpixel, in die der Scan und jedes Foto geteilt werden; in jedem ist höchstens ein Saatpunkt"
    ),
    "Take guessed colors from photos that could not be verified; they may be those of another place": (
        "Geratene Farben aus Fotos nehmen, die nicht bestätigt werden konnten; es können die eines anderen Ortes sein"
    ),
    "The method as published": "Das Verfahren, wie veröffentlicht",
    "What measured best on real scans: smoothed reflectance, fewer seeds per pixel, kriging": (
        "Was an echten Scans am besten maß: geglättete Reflektanz, weniger Saatpunkte je Pixel, Kriging"
    ),
    "Where the two chrominance channels are blended": "Wo die beiden Farbkanäle gemischt werden",
    "Which pixels a path may step to": "Zu welchen Pixeln ein Weg gehen darf",
    "Which seeds color a pixel": "Welche Saatpunkte ein Pixel färben",
    "Which settings to take over": "Welche Einstellungen zu übernehmen sind",
}

MESSAGES = {("*", text): german for tips in (_OPERATORS, _EXPORT, _LOOKS, _SETTINGS) for text, german in tips.items()}
