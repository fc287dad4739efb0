"""German: what the core says about scans, settings, seeds, colors, the kernel and a run as a whole."""

_SCANS = {
    "scan '{scan}': {note}": "Scan '{scan}': {note}",
    "{scan}: {text}": "{scan}: {text}",
    "{name}: {text}": "{name}: {text}",
    "{file}: scan '{scan}': {reason}": "{file}: Scan '{scan}': {reason}",
    "{file}: scan '{scan}' {problem}": "{file}: Scan '{scan}' {problem}",
    "has no grid: points that are neighbors by their numbers are not neighbors in space. Export it with rows and "
    "columns (structured E57, PTX), or {way}": (
        "hat kein Raster: Punkte, die der Nummer nach Nachbarn sind, sind es im Raum nicht. Mit Zeilen und Spalten "
        "exportieren (strukturiertes E57, PTX), oder {way}"
    ),
    "has no grid: its points have neither rows nor columns. Export it with rows and columns (structured E57, PTX), or "
    "{way}": (
        "hat kein Raster: seine Punkte haben weder Zeilen noch Spalten. Mit Zeilen und Spalten exportieren "
        "(strukturiertes E57, PTX), oder {way}"
    ),
    "have a grid laid over its points: --grid angle, or Grid by Angle in the import dialog": (
        "ein Raster über seine Punkte legen lassen: --grid angle, oder Raster nach Winkeln im Import-Dialog"
    ),
    "{file}: scan '{scan}' has no coordinates x, y and z": "{file}: Scan '{scan}' hat keine Koordinaten x, y und z",
    "{file}: scan '{scan}' has no pixel with a return; there is nothing to import": (
        "{file}: Scan '{scan}' hat kein Pixel mit einer Messung; es gibt nichts zu importieren"
    ),
    "{file}: scan '{scan}': the scanner's position is not known, and its points do not show it; give it with "
    "--position X Y Z, or Scanner Position in the import dialog": (
        "{file}: Scan '{scan}': der Standpunkt des Scanners ist nicht bekannt, und seine Punkte zeigen ihn nicht; "
        "angeben mit --position X Y Z, oder Standpunkt des Scanners im Import-Dialog"
    ),
    "a grid of {rows} x {columns} pixels was laid over its points by angle, as seen from {place}; {lost:,} points lie "
    "behind others and were left out": (
        "über seine Punkte wurde ein Raster von {rows} x {columns} Pixeln nach Winkeln gelegt, von {place} aus "
        "gesehen; {lost:,} Punkte liegen hinter anderen und wurden ausgelassen"
    ),
    "a grid by angle would have {rows:,} x {columns:,} pixels for {count:,} points; {way}": (
        "ein Raster nach Winkeln hätte {rows:,} x {columns:,} Pixel für {count:,} Punkte; {way}"
    ),
    "a grid by angle would have more than {most:,} rows or columns; {way}": (
        "ein Raster nach Winkeln hätte mehr als {most:,} Zeilen oder Spalten; {way}"
    ),
    "check the scanner's position, and the step if one was given": (
        "die Position des Scanners prüfen, und die Schrittweite, wenn eine angegeben wurde"
    ),
    "{count} points are too few for a grid by angle": "{count} Punkte sind zu wenige für ein Raster nach Winkeln",
    "the points lie in one line as seen from the scanner; there is no grid to lay over them": (
        "vom Scanner aus liegen die Punkte auf einer Linie; darüber lässt sich kein Raster legen"
    ),
    "{file}: none of its {count} scans can be used: {reason}": (
        "{file}: keiner ihrer {count} Scans ist zu gebrauchen: {reason}"
    ),
    "left out: {reason}": "ausgelassen: {reason}",
    "left out: {count:,} more scans, for similar reasons": "ausgelassen: {count:,} weitere Scans, aus solchen Gründen",
    "{count:,} points hold a number that is not finite, far too large or far too small, and were taken as no return": (
        "{count:,} Punkte enthalten eine Zahl, die nicht endlich, viel zu groß oder viel zu klein ist, und gelten als "
        "ohne Messung"
    ),
    "its colors hold values from {least:g} to {most:g}; taken as a scan without color": (
        "seine Farben haben Werte von {least:g} bis {most:g}; gilt als Scan ohne Farbe"
    ),
    "its colors hold values from {least:g} to {most:g}, which does not fit the scale from {low:g} to {high:g} in its "
    "header; they are taken as {scale}": (
        "seine Farben haben Werte von {least:g} bis {most:g}, was nicht zur Skala von {low:g} bis {high:g} im Kopf "
        "passt; sie gelten als {scale}"
    ),
    "no intensity but gray colors; they are taken as the intensity": (
        "keine Intensität, aber graue Farben; sie gelten als Intensität"
    ),
    "its colors are gray (red = green = blue); taken as a scan without color": (
        "seine Farben sind grau (Rot = Grün = Blau); gilt als Scan ohne Farbe"
    ),
    "has no intensity; the luminance of its colors stands in for the reflectance": (
        "hat keine Intensität; die Helligkeit seiner Farben vertritt die Reflektanz"
    ),
    "its intensity is {value:g} everywhere, as where a program knew none; the luminance of its colors stands in for "
    "the reflectance": (
        "seine Intensität ist überall {value:g}, wie von einem Programm, das keine kannte; die Helligkeit seiner "
        "Farben vertritt die Reflektanz"
    ),
    "has no intensity, and nothing that could stand in for it: it can be viewed, but not colorized": (
        "hat keine Intensität, und nichts, was sie vertreten könnte: er lässt sich ansehen, aber nicht einfärben"
    ),
    "its intensity is {value:g} everywhere, as where a program knew none: it can be viewed, but not colorized": (
        "seine Intensität ist überall {value:g}, wie von einem Programm, das keine kannte: er lässt sich ansehen, aber "
        "nicht einfärben"
    ),
    "{array}: expected numbers, found {kind}": "{array}: erwartet Zahlen, gefunden {kind}",
    "the pose holds a number that is not finite": "die Lage enthält eine Zahl, die nicht endlich ist",
    "the pose is not that of a scanner: expected 0 0 0 1 as its last row, and at most {most:g} m": (
        "die Lage ist nicht die eines Scanners: erwartet 0 0 0 1 als letzte Zeile, und höchstens {most:g} m"
    ),
    "a point": "einen Punkt",
    "a reflectance": "eine Reflektanz",
    "a valid pixel has {what} that is not finite": "ein gültiges Pixel hat {what} ohne endlichen Wert",
    "a valid pixel has {what} of {found:g}, expected at most {most:g}": (
        "ein gültiges Pixel hat {what} von {found:g}, erwartet höchstens {most:g}"
    ),
    "a scan is a grid of rows x columns, found shape {shape}": (
        "ein Scan ist ein Raster von Zeilen x Spalten, gefunden {shape}"
    ),
    "has {rows:,} rows x {columns:,} columns, expected at most {most:,} pixels": (
        "hat {rows:,} Zeilen x {columns:,} Spalten, erwartet höchstens {most:,} Pixel"
    ),
    "color must be uint8, found {kind}": "color muss uint8 sein, gefunden {kind}",
    "{array} has shape {shape}, expected {expected}": "{array} hat die Form {shape}, erwartet {expected}",
}

_SETTINGS = {
    "yes or no": "ja oder nein",
    "one of {choices}": "eines von {choices}",
    "a number from {low:g} to {high:g}": "eine Zahl von {low:g} bis {high:g}",
    "a whole number from {low:.7g} to {high:.7g}": "eine ganze Zahl von {low:.7g} bis {high:.7g}",
    "{number}, or one of {choices}": "{number}, oder eines von {choices}",
    "{setting}: expected {expected}, found {found!r}": "{setting}: erwartet {expected}, gefunden {found!r}",
    "{setting}: expected at least a block, which is hog_cell x hog_block = {least} pixels, found {found}": (
        "{setting}: erwartet mindestens einen Block, also hog_cell x hog_block = {least} Pixel, gefunden {found}"
    ),
    "{name}: expected {kind}, found {found}; {way}": "{name}: erwartet {kind}, gefunden {found}; {way}",
    "{name}: expected a whole number, found {value!r}": "{name}: erwartet eine ganze Zahl, gefunden {value!r}",
    "{field}: expected a finite number, found {value!r}": "{field}: erwartet eine endliche Zahl, gefunden {value!r}",
    "{name}: expected {expected}": "{name}: erwartet {expected}",
    "{name}: expected 0 or more, found {value!r}": "{name}: erwartet 0 oder mehr, gefunden {value!r}",
    "1 or more each": "je 1 oder mehr",
    "at most {most:,} pixels": "höchstens {most:,} Pixel",
    "left before right, at most 360 degrees apart": "links vor rechts, höchstens 360 Grad auseinander",
    "bottom below top, within -90 to 90 degrees": "unten unter oben, zwischen -90 und 90 Grad",
    "least below greatest, neither negative": "kleinste unter größter, keine negativ",
    "more than 0": "mehr als 0",
    "1 to 16": "1 bis 16",
    "0 to 1": "0 bis 1",
    "0 to {most}": "0 bis {most}",
    "Scanning {name}": "{name} wird gescannt",
    "Scanned {name}": "{name} gescannt",
}

_COLORS = {
    "Preparing the scan": "Scan wird vorbereitet",
    "Seed {number} of {count}": "Saatpunkt {number} von {count}",
    "{nearest} nearest of {count} seeds": "{nearest} nächste von {count} Saatpunkten",
    "{nearest} nearest seeds of {rows} rows x {columns} columns": (
        "{nearest} nächste Saatpunkte bei {rows} Zeilen x {columns} Spalten"
    ),
    "Mixing the colors": "Mischen der Farben",
    "Estimating by kriging": "Schätzen durch Kriging",
    "kriging is left out: it takes {most} seeds at most, found {count}": (
        "Kriging wird ausgelassen: es nimmt höchstens {most} Saatpunkte, gefunden {count}"
    ),
    "Joining what photos saw": "Gesehenes und Erschlossenes verbinden",
    "{scan}: joining what photos saw": "{scan}: Gesehenes und Erschlossenes verbinden",
    "{scan}: colorizing {rows} rows x {columns} columns": "{scan}: Einfärben von {rows} Zeilen x {columns} Spalten",
    "Writing the colors": "Farben werden geschrieben",
    "Colorized": "Eingefärbt",
    "--faces {count}: none of the outputs has a mesh; write one of {known}, or leave it out": (
        "--faces {count}: keine der Ausgaben hat ein Netz; eine von {known} schreiben, oder es weglassen"
    ),
    "Making the mesh lighter": "Netz wird leichter gemacht",
    "making the mesh lighter": "das Erzeugen des leichten Netzes",
    "Making the texture": "Textur wird erzeugt",
    "{scan}: has {found} faces instead of {faces}: what is left joins no more without a change of outlines": (
        "{scan}: hat {found} Flächen statt {faces}: was noch da ist, lässt sich nur zusammenfassen, wenn sich Umrisse "
        "ändern"
    ),
    "Looking for mixed returns": "Gemischte Messungen werden gesucht",
    "Filling small holes": "Kleine Löcher werden gefüllt",
    "Smoothing outlines": "Umrisse werden geglättet",
    "{count} pixels are cut off from every seed and keep their gray; add seeds there": (
        "{count} Pixel sind von allen Saatpunkten abgeschnitten und bleiben grau; dort Saatpunkte hinzufügen"
    ),
    "the colors are dark because most of the reflectance is; try tone {tone:g}": (
        "die Farben sind dunkel, weil die Reflektanz es größtenteils ist; Tonwert {tone:g} versuchen"
    ),
    "the colors are guesses: no seed was picked by a person or seen by a photo that was verified": (
        "die Farben sind geraten: kein Saatpunkt ist von einem Menschen gesetzt oder von einem bestätigten Foto gesehen"
    ),
    "{scan}: expected observed colors of {expected}, found {found}": (
        "{scan}: erwartet gesehene Farben von {expected}, gefunden {found}"
    ),
    "colors": "Farben",
    "true colors": "wahre Farben",
    "{image}: expected uint8, found {found}": "{image}: erwartet uint8, gefunden {found}",
    "{image}: expected an image of shape {shape}, found {found}": (
        "{image}: erwartet ein Bild der Form {shape}, gefunden {found}"
    ),
    "valid: expected booleans, found {kind}; write valid > 0": (
        "valid: erwartet Wahrheitswerte, gefunden {kind}; valid > 0 schreiben"
    ),
    "no pixel has both a return and a true color, so there is nothing to compare": (
        "kein Pixel hat eine Messung und eine wahre Farbe; es gibt nichts zu vergleichen"
    ),
}

_KERNEL = {
    "the native kernel did not load: {reason}": "der native Kern ließ sich nicht laden: {reason}",
    "the kernel refused {code}": "der Kern lehnte {code} ab",
    "luminance, range and valid must be images of one size, found {shapes}": (
        "luminance, range und valid müssen gleich große Bilder sein, gefunden {shapes}"
    ),
    "neighbors must be 4 or 8, found {neighbors}": "neighbors muss 4 oder 8 sein, gefunden {neighbors}",
    "{name} must be finite and at least 0, found {value}": (
        "{name} muss endlich und mindestens 0 sein, gefunden {value}"
    ),
    "a graph needs 1 to {most} pixels, found an image of {height} x {width}": (
        "ein Graph braucht 1 bis {most} Pixel, gefunden ein Bild von {height} x {width}"
    ),
    "luminance and range must be finite at every valid pixel, found NaN or infinity": (
        "luminance und range müssen an jedem gültigen Pixel endlich sein, gefunden NaN oder unendlich"
    ),
    "at least one seed pixel is needed, found an array of shape {shape}": (
        "mindestens ein Saatpixel ist nötig, gefunden ein Array der Form {shape}"
    ),
    "seed pixel {found} lies outside the image of {height} x {width}": (
        "Saatpixel {found} liegt außerhalb des Bildes von {height} x {width}"
    ),
    "the number of nearest seeds must be 1 to {most}, found {k}": (
        "die Zahl der nächsten Saatpunkte muss 1 bis {most} sein, gefunden {k}"
    ),
    "distances of shape {shape} do not fit an image {height} x {width}": (
        "Abstände der Form {shape} passen nicht zu einem Bild von {height} x {width}"
    ),
    "expected values of shape {expected}, found {shape}": "erwartet Werte der Form {expected}, gefunden {shape}",
    "alpha must be finite and at least 0, found {alpha}": (
        "alpha muss endlich und mindestens 0 sein, gefunden {alpha}"
    ),
    "expected values of shape (seeds, 1 to {most}), found {shape}": (
        "erwartet Werte der Form (seeds, 1 bis {most}), gefunden {shape}"
    ),
    "the seeds' values must be finite, found NaN or infinity": (
        "die Werte der Saatpunkte müssen endlich sein, gefunden NaN oder unendlich"
    ),
}

TEXTS = {**_SCANS, **_SETTINGS, **_COLORS, **_KERNEL}
