"""German: tooltips of what is kept with scans, seeds and images, and of the simulation."""

_SEEDS = {
    "A free line, closed by itself": "Eine freie Linie, von selbst geschlossen",
    "A rectangle": "Ein Rechteck",
    "A seed whose color was not picked yet colors nothing": (
        "Ein Saatpunkt, dessen Farbe noch nicht aufgenommen ist, färbt nichts"
    ),
    "Add a seed to what is selected, or take it off": "Einen Saatpunkt zur Auswahl nehmen, oder aus ihr",
    "By likeness with what a photo shows": "Nach Ähnlichkeit mit dem, was ein Foto zeigt",
    "Color of the scan at this pixel": "Farbe des Scans an diesem Pixel",
    "Color of the next seeds, and of selected ones without a color; choose it, or pick it in a photo": (
        "Farbe der nächsten Saatpunkte und der ausgewählten ohne Farbe; hier wählen oder im Foto aufnehmen"
    ),
    "How many seeds to take": "Wie viele Saatpunkte zu nehmen sind",
    "Color the scan anew whenever a seed or a setting changes, as a preview; Colorize keeps it, ESC or turning this "
    "off brings back what was there": (
        "Den Scan bei jeder Änderung eines Saatpunkts oder einer Einstellung neu färben, als Vorschau; Einfärben "
        "behält sie, ESC oder Ausschalten bringt zurück, was da war"
    ),
    "Column of the scan's grid, 0 at the left": "Spalte des Scans, 0 ist links",
    "Column of the seed that is meant; -1 for none": "Spalte des gemeinten Saatpunkts; -1 für keinen",
    "Confidence of unsure seeds is below this": "Die Verlässlichkeit unsicherer Saatpunkte liegt darunter",
    "Delete the seed": "Den Saatpunkt löschen",
    "Delete the seed at the pointer": "Den Saatpunkt am Mauszeiger löschen",
    "Deselect these": "Diese abwählen",
    "Every seed": "Jeder Saatpunkt",
    "How sure the color is": "Wie sicher die Farbe ist",
    "How the seed came by its color": "Wie der Saatpunkt zu seiner Farbe kam",
    "Join every seed in the reflectance image with its point in the photo beside it; else only selected ones": (
        "Jeden Saatpunkt im Reflektanzbild mit seinem Punkt im Foto daneben verbinden; sonst nur ausgewählte"
    ),
    "Keep the color for the next seeds, without noting the point of the photo": (
        "Die Farbe für die nächsten Saatpunkte behalten, ohne den Punkt des Fotos zu vermerken"
    ),
    "Keep the seed when the photos are matched again": (
        "Den Saatpunkt behalten, wenn die Fotos noch einmal zugeordnet werden"
    ),
    "Keep what is selected; a selected seed is deselected": (
        "Die Auswahl behalten; ein ausgewählter Saatpunkt wird abgewählt"
    ),
    "Let the selected seeds be replaced": "Die ausgewählten Saatpunkte ersetzen lassen",
    "Measured by the scanner itself": "Vom Scanner selbst gemessen",
    "Name of a loaded photo": "Name eines geladenen Fotos",
    "Name of a loaded photo; its color at Point is taken if given": (
        "Name eines geladenen Fotos; ist er gegeben, wird seine Farbe am Punkt genommen"
    ),
    "No seed": "Kein Saatpunkt",
    "Photo that the color was taken from": "Foto, aus dem die Farbe genommen wurde",
    "Photo that the picked color is from": "Foto, aus dem die aufgenommene Farbe ist",
    "Picked by a person": "Von einem Menschen gesetzt",
    "Pixels of the scan from one seed to the next when a stroke is drawn": (
        "Pixel des Scans von einem Saatpunkt zum nächsten, wenn ein Strich gezogen wird"
    ),
    "Pixels whose color is known": "Pixel, deren Farbe bekannt ist",
    "Place in that photo, in pixels from its top left corner": (
        "Ort in jenem Foto, in Pixeln von seiner linken oberen Ecke"
    ),
    "Place in the photo, in pixels from its top left corner": "Ort im Foto, in Pixeln von seiner linken oberen Ecke",
    "Place or select a seed, or pick a color": "Einen Saatpunkt setzen oder auswählen, oder eine Farbe aufnehmen",
    "Remove the seeds that are there before": "Die Saatpunkte, die schon da sind, vorher entfernen",
    "Row of the scan's grid, 0 at the top": "Zeile des Scans, 0 ist oben",
    "Row of the seed that is meant; -1 for none": "Zeile des gemeinten Saatpunkts; -1 für keinen",
    "Seed counted from 0, or -1 for the selected one": "Saatpunkt, von 0 gezählt, oder -1 für den ausgewählten",
    "Seed that is selected in the list": "Saatpunkt, der in der Liste ausgewählt ist",
    "Seeds that wait for their color": "Saatpunkte, die auf ihre Farbe warten",
    "Seeds that were found in photos": "Saatpunkte, die in Fotos gefunden wurden",
    "Seeds that were found in photos with less than a given confidence": (
        "Saatpunkte, die in Fotos gefunden wurden, mit weniger als einer gegebenen Verlässlichkeit"
    ),
    "Seeds to select": "Auszuwählende Saatpunkte",
    "Select these only": "Nur diese auswählen",
    "Select these, too": "Diese auch auswählen",
    "Take the color for the next seeds": "Die Farbe für die nächsten Saatpunkte nehmen",
    "Take the nearest pixel that has a return, where this one has none": (
        "Das nächste Pixel mit einer Messung nehmen, wo dieses keine hat"
    ),
    "The next seed is given the picked color": "Der nächste Saatpunkt bekommt die aufgenommene Farbe",
    "What becomes of the selection": "Was aus der Auswahl wird",
    "What is drawn around the seeds": "Was um die Saatpunkte gezogen wird",
    "What to do at the pointer": "Was am Mauszeiger zu tun ist",
    "Where a photo's verified camera saw the pixel": "Wo die bestätigte Kamera eines Fotos das Pixel sah",
    "Where a verified photo shows the pixel": "Wo ein bestätigtes Foto das Pixel zeigt",
    "Whether the seed is selected in the Image Editors": "Ob der Saatpunkt in den Bildeditoren ausgewählt ist",
}

_SCANS = {
    "Where the scanner stood, in the file's coordinates and unit": (
        "Wo der Scanner stand, in Koordinaten und Einheit der Datei"
    ),
    "Say where the scanner stood, for points that are not measured from it": (
        "Sagen, wo der Scanner stand, für Punkte, die nicht von ihm aus gemessen sind"
    ),
    "Lay a grid over the points by the angles at which the scanner saw them, for files without one": (
        "Ein Raster nach den Winkeln über die Punkte legen, unter denen der Scanner sie sah, für Dateien ohne eines"
    ),
    "The farthest one": ("Das fernste"),
    "The one with the most reflectance": ("Das mit der höchsten Reflektanz"),
    "The nearest one": ("Das nächste"),
    "Which of several returns of a pixel to take": ("Welches von mehreren Echos eines Pixels zu nehmen ist"),
    "Read only every so many rows and columns of the file, which saves time and memory on large scans": (
        "Nur jede so vielte Zeile und Spalte der Datei lesen; das spart bei großen Scans Zeit und Speicher"
    ),
    "International feet": ("Internationale Fuß"),
    "As depth cameras count": ("Wie Tiefenkameras zählen"),
    "Meters, unless the points tell otherwise": ("Meter, wenn die Punkte nichts anderes sagen"),
    "What the coordinates in the file count": ("Was die Koordinaten in der Datei zählen"),
    "By a quarter to the left": ("Um ein Viertel nach links"),
    "Upside down": ("Auf den Kopf"),
    "By a quarter to the right": ("Um ein Viertel nach rechts"),
    "Leave it as the points tell": ("Lassen, wie die Punkte es sagen"),
    "Turn the scan's image clockwise, where the file's order is misread": (
        "Das Bild des Scans im Uhrzeigersinn drehen, wo die Reihenfolge der Datei falsch gelesen wird"
    ),
    "A camera's perspective, as a time-of-flight camera has it": (
        "Die Perspektive einer Kamera, wie eine Laufzeitkamera sie hat"
    ),
    "Direction of the image's bottom edge, up from the horizon": (
        "Richtung der unteren Bildkante, vom Horizont aufwärts"
    ),
    "Direction of the image's left edge, to the right from straight ahead": (
        "Richtung der linken Bildkante, von geradeaus nach rechts"
    ),
    "Direction of the image's right edge, to the right from straight ahead": (
        "Richtung der rechten Bildkante, von geradeaus nach rechts"
    ),
    "Direction of the image's top edge, up from the horizon": "Richtung der oberen Bildkante, vom Horizont aufwärts",
    "Equal angles from pixel to pixel, as a turning laser scanner has them": (
        "Gleiche Winkel von Pixel zu Pixel, wie ein drehender Laserscanner sie hat"
    ),
    "Faces steeper than this against the viewing ray are jumps between surfaces and are left out": (
        "Steiler zum Sehstrahl stehende Flächen sind Sprünge zwischen Oberflächen und werden weggelassen"
    ),
    "File that the scan was read from": "Datei, aus der der Scan gelesen wurde",
    "Focal length across, in pixels": "Brennweite in der Breite, in Pixeln",
    "Focal length down, in pixels": "Brennweite in der Höhe, in Pixeln",
    "Height of the scan's grid in pixels": "Höhe des Scans in Pixeln",
    "How the pixels of a range image look into the scene": (
        "Wie die Pixel eines Entfernungsbildes in die Szene blicken"
    ),
    "Image with one pixel per pixel of the scan, to compare the colors with; if empty, the colors that came with the "
    "scan": (
        "Bild mit einem Pixel je Pixel des Scans, um die Farben damit zu vergleichen; wenn leer, die Farben, die mit "
        "dem Scan kamen"
    ),
    "Image with one pixel per pixel of the scan; by default the one chosen for the scan, or the colors that came with "
    "it": (
        "Bild mit einem Pixel je Pixel des Scans; sonst das für den Scan gewählte, oder die Farben, die mit ihm kamen"
    ),
    "Meters for one unit of the range image, 0.001 for millimeters; 0 to guess it from its values": (
        "Meter für eine Einheit des Entfernungsbildes, 0.001 für Millimeter; 0, um sie aus seinen Werten zu schätzen"
    ),
    "A guess from the shape of the images; what comes of it is shown below": (
        "Nach der Form der Bilder geschätzt; was daraus wird, steht darunter"
    ),
    "For range images that are no linear measure, instead of the scale: pairs of a value and meters, such as 0 0.5, "
    "128 3, 255 12": (
        "Für Entfernungsbilder, die nicht linear messen, statt des Maßstabs: Paare von Wert und Metern, etwa 0 0.5, "
        "128 3, 255 12"
    ),
    "How a third image, of colors, stores them": "Wie ein drittes Bild, das der Farben, sie speichert",
    "As most images": "Wie die meisten Bilder",
    "For images whose red and blue come in swapped": "Für Bilder, deren Rot und Blau vertauscht ankommen",
    "Put the photos that an E57 holds on the list of photos, to take colors from": (
        "Die Fotos, die eine E57-Datei enthält, auf die Liste der Fotos setzen, um Farben daraus zu nehmen"
    ),
    "For photos whose colors come in wrong because a program stored blue where red belongs": (
        "Für Fotos mit falschen Farben, weil ein Programm Blau speicherte, wo Rot hingehört"
    ),
    "Mirror the scan's grid, where the file's order is misread": (
        "Den Scan seitlich spiegeln, wo die Reihenfolge der Datei falsch gelesen wird"
    ),
    "Principal point across, in pixels from the center of the first column": (
        "Hauptpunkt in der Breite, in Pixeln von der Mitte der ersten Spalte"
    ),
    "Principal point down, in pixels from the center of the first row": (
        "Hauptpunkt in der Höhe, in Pixeln von der Mitte der ersten Zeile"
    ),
    "Let a .scan.json name images outside of its own folder, for files whose sender is trusted": (
        "Einer .scan.json erlauben, Bilder außerhalb ihres Ordners zu nennen; nur für Dateien aus sicherer Hand"
    ),
    "Take the other one of the two images as the range image": "Das andere Bild als Entfernungsbild nehmen",
    "The scan's range as a picture": "Die Entfernung des Scans als Bild",
    "The scan's reflectance as a picture": "Die Reflektanz des Scans als Bild",
    "Turn the scan's grid upside down, where the file's order is misread": (
        "Den Scan auf den Kopf stellen, wo die Reihenfolge der Datei falsch gelesen wird"
    ),
    "Width of the scan's grid in pixels": "Breite des Scans in Pixeln",
}

_IMAGES = {
    "Colors that follow the seeds until they are kept": "Farben, die den Saatpunkten folgen, bis sie behalten werden",
    "Lay the colors over the scan's image, right of a line that can be dragged": (
        "Die Farben über das Bild des Scans legen, rechts einer Linie, die sich ziehen lässt"
    ),
    "Message that is selected in the list": "Meldung, die in der Liste ausgewählt ist",
    "Photo that is selected in the list": "Foto, das in der Liste ausgewählt ist",
    "Photos that colors are taken from": "Fotos, aus denen Farben genommen werden",
    "The photo's picture": "Das Bild des Fotos",
    "What was found": "Was gefunden wurde",
    "What was found of each photo on this scan": "Was von jedem Foto auf diesem Scan gefunden wurde",
    "Results and warnings of the last operation": "Ergebnisse und Warnungen der letzten Handlung",
    "What was said": "Was gemeldet wurde",
    "Where each seed's color comes from": "Woher die Farbe jedes Saatpunkts kommt",
    "Where the line is, from the left to the right edge of the image": (
        "Wo die Linie ist, von der linken zur rechten Kante des Bildes"
    ),
    "Whether it is a warning, not a result": "Ob es eine Warnung ist, kein Ergebnis",
}

_SIMULATION = {
    "Angle from the left to the right edge of the scan": "Winkel von der linken zur rechten Kante des Scans",
    "At the 3D cursor, looking along its Y axis": "Am 3D-Cursor, mit Blick entlang seiner Y-Achse",
    "At the camera of the scene, looking as it does": "An der Kamera der Szene, mit ihrem Blick",
    "At the origin of the active object, looking along its Y axis": (
        "Am Ursprung des aktiven Objekts, mit Blick entlang seiner Y-Achse"
    ),
    "Direction of the bottom edge, up from the horizon": "Richtung der unteren Kante, vom Horizont aufwärts",
    "Direction of the top edge, up from the horizon": "Richtung der oberen Kante, vom Horizont aufwärts",
    "Give each photo an exposure, white balance, lens distortion and noise of its own": (
        "Jedem Foto eigene Belichtung, eigenen Weißabgleich, eigene Verzeichnung und eigenes Rauschen geben"
    ),
    "Light paths for each pixel of a photo": "Lichtwege für jedes Pixel eines Fotos",
    "Nothing is measured beyond, in meters": "Darüber hinaus wird nichts gemessen, in Metern",
    "Start of the random numbers; the same start gives the same scan": (
        "Anfang der Zufallszahlen; derselbe Anfang gibt denselben Scan"
    ),
    "Pixels from left to right": "Pixel von links nach rechts",
    "Pixels from top to bottom": "Pixel von oben nach unten",
    "Scan all around": "Rundum scannen",
    "Share of the pixels that give no return for no reason": "Anteil der Pixel, die ohne Grund keine Messung geben",
    "Standard deviation of the range of a bright surface, in meters": (
        "Standardabweichung der Entfernung einer hellen Oberfläche, in Metern"
    ),
    "Standard deviation of the reflectance, relative to it": (
        "Standardabweichung der Reflektanz, im Verhältnis zu ihr"
    ),
    "Take a photo from every camera of the scene but the scanner's": (
        "Von jeder Kamera der Szene außer der des Scanners ein Foto machen"
    ),
    "Where the scanner stands; it is leveled and looks as that does": (
        "Wo der Scanner steht; er ist waagerecht und blickt wie dieses"
    ),
    "Width of the laser beam; surfaces that share a beam at an edge become one point between them": (
        "Breite des Laserstrahls; Oberflächen, die sich an einer Kante einen teilen, werden ein Punkt dazwischen"
    ),
    "Write an image of the true color of every pixel of the scan": (
        "Ein Bild der wahren Farbe jedes Pixels des Scans schreiben"
    ),
}

MESSAGES = {("*", text): german for tips in (_SEEDS, _SCANS, _IMAGES, _SIMULATION) for text, german in tips.items()}
