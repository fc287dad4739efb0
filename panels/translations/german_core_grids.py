"""German: what the readers say about other scan files, image pairs, and grids."""

_FORMATS = {
    "{file}: no such file, expected {expected}": "{file}: keine solche Datei, erwartet {expected}",
    "a scan file ({suffixes})": "eine Scandatei ({suffixes})",
    "{file}: this format is not supported. {way}": "{file}: dieses Format wird nicht unterstützt. {way}",
    "Autodesk: export its scans from ReCap as E57 or PTS": "Autodesk: die Scans aus ReCap als E57 oder PTS exportieren",
    "Callidus: open it in 3D-Extractor and export it as PTX or PTS": (
        "Callidus: in 3D-Extractor öffnen und als PTX oder PTS exportieren"
    ),
    "FARO: open it in FARO SCENE and export it as E57 (structured) or PTX": (
        "FARO: in FARO SCENE öffnen und als E57 (strukturiert) oder PTX exportieren"
    ),
    "Leica: open it in Cyclone and export it as PTX or E57 (structured)": (
        "Leica: in Cyclone öffnen und als PTX oder E57 (strukturiert) exportieren"
    ),
    "RIEGL: export it from RiSCAN PRO or RiPROCESS as E57 with rows and columns": (
        "RIEGL: aus RiSCAN PRO oder RiPROCESS als E57 mit Zeilen und Spalten exportieren"
    ),
    "Topcon: open it in ScanMaster or Magnet Collage and export it as E57 or PTX": (
        "Topcon: in ScanMaster oder Magnet Collage öffnen und als E57 oder PTX exportieren"
    ),
    "Trimble: open it in RealWorks and export it as E57 (gridded) or PTX": (
        "Trimble: in RealWorks öffnen und als E57 (mit Raster) oder PTX exportieren"
    ),
    "Zoller + Froehlich: open it in LaserControl and export it as E57 (structured) or PTX": (
        "Zoller + Fröhlich: in LaserControl öffnen und als E57 (strukturiert) oder PTX exportieren"
    ),
    "a recording of ROS: save its frames as organized PCD or NumPy arrays": (
        "eine Aufzeichnung von ROS: ihre Einzelbilder als geordnetes PCD oder NumPy-Arrays speichern"
    ),
    "packets of a spinning lidar: save its frames with the maker's tools as NumPy arrays or PCD": (
        "Pakete eines rotierenden Lidars: die Einzelbilder mit den Werkzeugen des Herstellers als NumPy-Arrays oder "
        "PCD speichern"
    ),
    "{file}: not a scan file by its name, expected one of {known}": (
        "{file}: dem Namen nach keine Scandatei, erwartet eine von {known}"
    ),
    "{file}: not a scan file by its name, expected one of {known}; its contents look like {contents}: rename it": (
        "{file}: dem Namen nach keine Scandatei, erwartet eine von {known}; der Inhalt sieht nach {contents} aus: "
        "umbenennen"
    ),
    "{file}: its contents look like {contents}: rename it": (
        "{file}: der Inhalt sieht nach {contents} aus: umbenennen"
    ),
    "Reading {file}": "{file} wird gelesen",
    "Reading {file}: {name}": "{file} wird gelesen: {name}",
    "step: expected a whole number of at least 1, found {found}": (
        "Schrittweite: erwartet eine ganze Zahl ab 1, gefunden {found}"
    ),
    "{name}: expected one of {choices}, found {found}": "{name}: erwartet eines von {choices}, gefunden {found}",
    "unknown option {name}; expected one of {known}": "unbekannte Einstellung {name}; erwartet eine von {known}",
    "position: expected three numbers, found {found}": "position: erwartet drei Zahlen, gefunden {found}",
    "{name}: expected {expected}, found {found}": "{name}: erwartet {expected}, gefunden {found}",
    "true or false": "true oder false",
    "a text in quotes": "ein Text in Anführungszeichen",
    "{file}: is UTF-16 text, expected plain text: save it as ASCII or UTF-8": (
        "{file}: ist Text in UTF-16, erwartet einfacher Text: als ASCII oder UTF-8 speichern"
    ),
    "{file}: line {line}: {problem}": "{file}: Zeile {line}: {problem}",
    "longer than any line of numbers; not a text file": "länger als jede Zeile von Zahlen; keine Textdatei",
    "expected points as lines of 3, 4, 6 or 7 numbers, all lines alike": (
        "erwartet Punkte als Zeilen von 3, 4, 6 oder 7 Zahlen, alle gleich lang"
    ),
    "expected 3, 4, 6 or 7 numbers, found {count}": "erwartet 3, 4, 6 oder 7 Zahlen, gefunden {count}",
    "{file}: holds more than {count:,} points": "{file}: enthält mehr als {count:,} Punkte",
    "{file}: holds no points": "{file}: enthält keine Punkte",
}

_PCD_PLY = {
    "expected lines of {count} numbers": "erwartet Zeilen von {count} Zahlen",
    "{file}: its compressed points are damaged": "{file}: die komprimierten Punkte sind beschädigt",
    "{file}: {key} is {found}, expected a whole number": "{file}: {key} ist {found}, erwartet eine ganze Zahl",
    "{file}: expected a number, found '{found}'": "{file}: erwartet eine Zahl, gefunden '{found}'",
    "{file}: holds less than its header says; it is cut short": (
        "{file}: enthält weniger, als ihr Kopf sagt; sie ist abgeschnitten"
    ),
    "{file}: claims {count:,} points": "{file}: gibt {count:,} Punkte an",
    "{file}: DATA is {found}, expected ascii, binary or binary_compressed": (
        "{file}: DATA ist {found}, erwartet ascii, binary oder binary_compressed"
    ),
    "{file}: its header is cut short": "{file}: ihr Kopf ist abgeschnitten",
    "{file}: not a PCD: its header has a line {found}": "{file}: kein PCD: ihr Kopf hat eine Zeile {found}",
    "{file}: its header has no {key}": "{file}: ihr Kopf hat kein {key}",
    "{file}: FIELDS, SIZE, TYPE and COUNT of its header differ in length": (
        "{file}: FIELDS, SIZE, TYPE und COUNT im Kopf sind verschieden lang"
    ),
    "{file}: its header has a field of an unknown type": "{file}: ihr Kopf hat ein Feld von unbekanntem Typ",
    "{file}: line {line}: not a line of a PLY's header": "{file}: Zeile {line}: keine Zeile eines PLY-Kopfes",
    "{file}: its header is damaged": "{file}: ihr Kopf ist beschädigt",
    "{file}: a pose in its header is damaged": "{file}: eine Lage in ihrem Kopf ist beschädigt",
    "{file}: its vertices hold lists": "{file}: ihre Punkte enthalten Listen",
    "{file}: lists stand before its vertices": "{file}: vor ihren Punkten stehen Listen",
    "expected a list of whole numbers": "erwartet eine Liste ganzer Zahlen",
    "{file}: holds no vertices": "{file}: enthält keine Punkte",
    "{file}: its range grid names vertices that it does not have": (
        "{file}: ihr Raster nennt Punkte, die sie nicht hat"
    ),
}

_NUMPY = {
    "{file}: expected x, y and z, or range with azimuth and elevation; it holds {found}. Where there are no angles, a "
    ".scan.json beside it can give them (docs/formats.md)": (
        "{file}: erwartet x, y und z, oder range mit azimuth und elevation; sie enthält {found}. Wo Winkel fehlen, "
        "kann eine .scan.json daneben sie angeben (docs/formats.md)"
    ),
    "{file}: azimuth and elevation do not fit the range's size": (
        "{file}: azimuth und elevation passen nicht zur Größe von range"
    ),
    "{file}: holds {count:,} arrays": "{file}: enthält {count:,} Arrays",
    "{file}: claims to hold more than a file of its size can": (
        "{file}: will mehr enthalten, als eine Datei ihrer Größe kann"
    ),
    "{file}: is encrypted; save it without a password": "{file}: ist verschlüsselt; ohne Passwort speichern",
    "{file}: uses a compression that NumPy does not write": (
        "{file}: ist auf eine Weise komprimiert, die NumPy nicht schreibt"
    ),
    "{file}: it is damaged or cut short, or holds something other than arrays of numbers": (
        "{file}: ist beschädigt oder abgeschnitten, oder enthält etwas anderes als Arrays von Zahlen"
    ),
    "{file}: one of its arrays claims more data than the file can hold": (
        "{file}: eines ihrer Arrays will mehr Daten enthalten, als die Datei kann"
    ),
    "{file}: has no array {member} of numbers, it holds {found}": (
        "{file}: hat kein Array {member} von Zahlen, sie enthält {found}"
    ),
    "{file}: x, y and z differ in size": "{file}: x, y und z sind verschieden groß",
    "{file}: holds an array of {shape}, expected rows x columns x 3 (x, y, z) or 4 (and reflectance)": (
        "{file}: enthält ein Array von {shape}, erwartet Zeilen x Spalten x 3 (x, y, z) oder 4 (und Reflektanz)"
    ),
    "NumPy arrays": "NumPy-Arrays",
    "of its own": "für sich allein",
    "nothing": "nichts",
}

_PAIRS = {
    "{file}: model.elevation_deg: has {count} numbers, expected {rows}, one for each row of {image}": (
        "{file}: model.elevation_deg: hat {count} Zahlen, erwartet {rows}, eine je Zeile von {image}"
    ),
    "{file}: {image} has no pixel with a return; there is nothing to import": (
        "{file}: {image} hat kein Pixel mit einer Messung; es gibt nichts zu importieren"
    ),
    "{file}: {key}: {image} lies outside of the folder of {file}; put it there, or allow outside files": (
        "{file}: {key}: {image} liegt außerhalb des Ordners von {file}; dorthin legen oder Dateien von außerhalb "
        "erlauben"
    ),
    "{file}: {key}: {problem}": "{file}: {key}: {problem}",
    "{file}: {key}: expected an array of rows x columns, for colors of rows x columns x 3 of 8 bits": (
        "{file}: {key}: erwartet ein Array von Zeilen x Spalten, für Farben von Zeilen x Spalten x 3 mit 8 Bit"
    ),
    "{file}: {key}: {image} has {rows} rows x {columns} columns, expected {expected_rows} x {expected_columns} as the "
    "range image has": (
        "{file}: {key}: {image} hat {rows} Zeilen x {columns} Spalten, erwartet {expected_rows} x {expected_columns} "
        "wie das Entfernungsbild"
    ),
    "{file}: range_scale: missing; {image} holds whole numbers: give the meters per unit (0.001 for millimeters)": (
        "{file}: range_scale: fehlt; {image} enthält ganze Zahlen: die Meter je Einheit angeben (0.001 für Millimeter)"
    ),
    "{image} holds {code} in {count:,} pixels, far from all others: they were taken as no return": (
        "{image} hat in {count:,} Pixeln den Wert {code}, fern von allen anderen: sie gelten als ohne Messung"
    ),
    "range: {image}, {bits} bits": "Entfernung: {image}, {bits} Bit",
    "reflectance: {image}": "Reflektanz: {image}",
    "color: {image}": "Farbe: {image}",
    "8 bits do not give their scale; {most:g} m is a guess for the brightest value: give a scale, or a table": (
        "8 Bit sagen nichts über ihren Maßstab; {most:g} m für den hellsten Wert sind geraten: einen Maßstab oder eine "
        "Tabelle angeben"
    ),
    '{first}: one of three images has to hold the colors; put "rgb" into its name': (
        "{first}: eines von drei Bildern muss die Farben enthalten; „rgb“ in seinen Namen schreiben"
    ),
    "{first}: pick a range and a reflectance image together": (
        "{first}: ein Entfernungs- und ein Reflektanzbild zusammen auswählen"
    ),
    '{first}, {second}: cannot tell which is the range image; put "depth" or "range" into its file name': (
        "{first}, {second}: welches ist das Entfernungsbild? „depth“ oder „range“ in seinen Dateinamen schreiben"
    ),
    "pinhole, focal length {focal:.0f} pixels": "Lochkamera, Brennweite {focal:.0f} Pixel",
    "spherical, {across:.0f} degrees across, from {bottom:.0f} to {top:.0f} degrees up": (
        "sphärisch, {across:.0f} Grad breit, von {bottom:.0f} bis {top:.0f} Grad Höhe"
    ),
    "no pixel has a range": "kein Pixel hat eine Entfernung",
    "mesh: {width:.2f} x {depth:.2f} x {height:.2f} m": "Netz: {width:.2f} x {depth:.2f} x {height:.2f} m",
    "{near:.2f} to {far:.2f} m away": "{near:.2f} bis {far:.2f} m entfernt",
    "its points are {usual:.3g} m away; check the range's scale": (
        "seine Punkte sind {usual:.3g} m entfernt; den Maßstab der Entfernung prüfen"
    ),
    "its pixels would be {shape:.2g} times as wide as high; check the angles": (
        "seine Pixel wären {shape:.2g}-mal so breit wie hoch; die Winkel prüfen"
    ),
    "all around, its points are {usual:.2f} m away, as in a bowl; check the sensor and the range's scale": (
        "rundum sind seine Punkte {usual:.2f} m entfernt, wie in einer Schüssel; den Sensor und den Maßstab der "
        "Entfernung prüfen"
    ),
    "its left and right edges do not meet, as they would in a full turn; it may be a camera's image: choose Pinhole": (
        "linker und rechter Rand passen nicht zusammen, wie sie es bei einer vollen Drehung täten; es ist wohl das "
        "Bild einer Kamera: Lochkamera wählen"
    ),
    'range table: expected pairs such as "0 0.5, 255 12", found {found}': (
        "Entfernungstabelle: erwartet Paare wie „0 0.5, 255 12“, gefunden {found}"
    ),
}

_DESCRIPTIONS = {
    "a JSON description of a scan": "die Beschreibung eines Scans in JSON",
    "{file}: expected a name that ends in .scan.json": "{file}: erwartet einen Namen mit der Endung .scan.json",
    '{file}: expected a JSON object with "format": "{format}"': (
        '{file}: erwartet ein JSON-Objekt mit "format": "{format}"'
    ),
    "{file}: range_table: replaces range_scale and range_offset; give one or the other": (
        "{file}: range_table: ersetzt range_scale und range_offset; das eine oder das andere angeben"
    ),
    "{file}: {key}: expected {expected}, found {found}": "{file}: {key}: erwartet {expected}, gefunden {found}",
    "{file}: {key}: unknown key, expected one of {known}": (
        "{file}: {key}: unbekannter Schlüssel, erwartet einer von {known}"
    ),
    "{file}: {key}: is missing": "{file}: {key}: fehlt",
    "a number from {low:,.12g} to {high:,.12g}": "eine Zahl von {low:,.12g} bis {high:,.12g}",
    "a matrix that can be inverted, with 0 0 0 1 as its last row and at most {most:g} m": (
        "eine umkehrbare Matrix, mit 0 0 0 1 als letzter Zeile und höchstens {most:g} m"
    ),
    "{version} (this file needs a newer release)": "{version} (diese Datei braucht eine neuere Version)",
    "a text in one line": "ein Text in einer Zeile",
    "two numbers in degrees": "zwei Zahlen in Grad",
    "two numbers 0.000001 to {widest} degrees apart": "zwei Zahlen, 0,000001 bis {widest} Grad auseinander",
    "an object with a type": "ein Objekt mit einem Typ",
    "4, 5 or 8 numbers: k1, k2, p1, p2, k3, k4, k5, k6": "4, 5 oder 8 Zahlen: k1, k2, p1, p2, k3, k4, k5, k6",
    "as many numbers as elevation_deg has": "so viele Zahlen, wie elevation_deg hat",
    "a list of degrees, one for each row": "eine Liste in Grad, eine Zahl je Zeile",
    "a list of at least two [value, meters] with growing values": (
        "eine Liste von mindestens zwei [Wert, Meter] mit steigenden Werten"
    ),
    "4 rows of 4 numbers": "4 Zeilen von 4 Zahlen",
}

TEXTS = {**_FORMATS, **_PCD_PLY, **_NUMPY, **_PAIRS, **_DESCRIPTIONS}
