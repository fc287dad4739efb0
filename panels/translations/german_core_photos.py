"""German: what the core says about seeds, photos, reports and a run as a whole."""

_SEEDS = {
    "a JSON file of seeds": "eine JSON-Datei mit Saatpunkten",
    "no seeds: add at least one pixel with a color": (
        "keine Saatpunkte: mindestens ein Pixel mit einer Farbe hinzufügen"
    ),
    "{scan}: it came without colors; give seeds another way": (
        "{scan}: er kam ohne Farben; Saatpunkte auf andere Weise angeben"
    ),
    "{scan}: no pixel has a return, so no seed can be placed": (
        "{scan}: kein Pixel hat eine Messung, also kann kein Saatpunkt gesetzt werden"
    ),
    "seed {seed}: row {row}, column {col} is outside the scan's grid (rows 0 to {last_row}, columns 0 to {last_col})": (
        "Saatpunkt {seed}: Zeile {row}, Spalte {col} liegt außerhalb des Scanrasters (Zeilen 0 bis {last_row}, Spalten "
        "0 bis {last_col})"
    ),
    "seed {seed}: no return at row {row}, column {column}; moved to row {to_row}, column {to_column}": (
        "Saatpunkt {seed}: keine Messung in Zeile {row}, Spalte {column}; "
        "verschoben nach Zeile {to_row}, Spalte {to_column}"
    ),
    "{count} of {all} seeds lie where {scan} has no return, and were moved to the nearest pixel with one; are they of "
    "another scan?": (
        "{count} von {all} Saatpunkten liegen, wo {scan} keine Messung hat, und wurden zum nächsten Pixel mit einer "
        "verschoben; gehören sie zu einem anderen Scan?"
    ),
    "seeds: {name}: expected whole numbers, found {dtype}": (
        "Saatpunkte: {name}: erwartet ganze Zahlen, gefunden {dtype}"
    ),
    "seeds: {name}: expected 0 to 255, found {low} to {high}": (
        "Saatpunkte: {name}: erwartet 0 bis 255, gefunden {low} bis {high}"
    ),
    "seeds: {name} has shape {shape}, expected {expected}": (
        "Saatpunkte: {name} hat die Form {shape}, erwartet {expected}"
    ),
    "seeds: {count} photo names for {seeds} seeds": "Saatpunkte: {count} Fotonamen für {seeds} Saatpunkte",
    "seeds: {count} reasons for {seeds} seeds": "Saatpunkte: {count} Herkunftsangaben für {seeds} Saatpunkte",
    "seeds: reason: expected one of {choices}, found {found!r}": (
        "Saatpunkte: reason: erwartet eines von {choices}, gefunden {found!r}"
    ),
    "{file}: photo {name} may be {one} or {other}; give them different names": (
        "{file}: Foto {name} kann {one} oder {other} sein; ihnen verschiedene Namen geben"
    ),
    "point {x:g}, {y:g} is outside the photo ({width} x {height} pixels)": (
        "Punkt {x:g}, {y:g} liegt außerhalb des Fotos ({width} x {height} Pixel)"
    ),
    '{path}: "version": expected {expected}, found {found}': '{path}: "version": erwartet {expected}, gefunden {found}',
    '{path}: "seeds": expected a list, found {value}': '{path}: "seeds": erwartet eine Liste, gefunden {value}',
    "{where}: expected an object with row, col and a color, found {entry}": (
        "{where}: erwartet ein Objekt mit row, col und einer Farbe, gefunden {entry}"
    ),
    "{where}: {key}: not a key of a seed; known are {choices}": (
        "{where}: {key}: kein Schlüssel eines Saatpunkts; bekannt sind {choices}"
    ),
    "{where}: photo: expected a file name, found {photo}": (
        "{where}: photo: erwartet einen Dateinamen, gefunden {photo}"
    ),
    "{where}: rgb: expected three whole numbers from 0 to 255, found {rgb}": (
        "{where}: rgb: erwartet drei ganze Zahlen von 0 bis 255, gefunden {rgb}"
    ),
    "{where}: {photo}: {error}": "{where}: {photo}: {error}",
    "{where}: expected a color: either rgb, or photo with x and y": (
        "{where}: erwartet eine Farbe: entweder rgb, oder photo mit x und y"
    ),
    "{where}: reason: expected one of {choices}, found {reason}": (
        "{where}: reason: erwartet eines von {choices}, gefunden {reason}"
    ),
    "{where}: locked: expected true or false, found {found}": (
        "{where}: locked: erwartet true oder false, gefunden {found}"
    ),
    "{where}: {key}: expected {expected}, found {value}": "{where}: {key}: erwartet {expected}, gefunden {value}",
    "a number": "eine Zahl",
    "a whole number": "eine ganze Zahl",
    "{where}: photo {name} was not given and is not beside the seeds' file": (
        "{where}: Foto {name} ist nicht angegeben und liegt nicht neben der Datei der Saatpunkte"
    ),
}

_MATCHING = {
    "Learning the materials": "Materialien werden gelernt",
    "Superpixels of the scan": "Superpixel des Scans",
    "Comparing superpixels": "Superpixel werden verglichen",
    "{scan}: superpixels": "{scan}: Superpixel",
    "{scan}: comparing superpixels": "{scan}: Superpixel werden verglichen",
    "{scan}: transferring colors": "{scan}: Farben werden übertragen",
    "{scan}: blending photos": "{scan}: Fotos werden überblendet",
    "{photo}: superpixels": "{photo}: Superpixel",
    "{photo}: matching features": "{photo}: Merkmale werden verglichen",
    "{photo}: searching directions": "{photo}: Richtungen werden abgesucht",
    "{photo}: searching viewpoints": "{photo}: Standpunkte werden abgesucht",
    "{photo}: trying directions": "{photo}: Richtungen werden ausprobiert",
    "{photo}: refining": "{photo}: wird verfeinert",
    "{photo}: refining the picked pairs": "{photo}: gewählte Paare werden verfeinert",
    "{photo}: looking for what repeats": "{photo}: Wiederholungen werden gesucht",
    "{photo}: trying its place on {other}": "{photo}: seine Lage auf {other} wird ausprobiert",
    "{photo}: trying its place in the file": "{photo}: seine Lage in der Datei wird ausprobiert",
    "{photo}: comparing with {other}": "{photo}: wird mit {other} verglichen",
    "{photo}: trying its place by {other}": "{photo}: seine Lage nach {other} wird ausprobiert",
    "{photo}: is black and white, it gives no colors": "{photo}: ist schwarzweiß, es gibt keine Farben",
    "Opening the photos": "Fotos werden geöffnet",
    "Matched": "Zugeordnet",
    "{scan}: no pixel has a return, so nothing can be matched": (
        "{scan}: kein Pixel hat eine Messung, also kann nichts zugeordnet werden"
    ),
    "no photo: give at least one": "kein Foto: mindestens eines angeben",
    "{photo}: expected (H, W, 3) uint8, found {shape} {dtype}": (
        "{photo}: erwartet (H, W, 3) uint8, gefunden {shape} {dtype}"
    ),
    "{photo}: has {width} x {height} pixels, expected at least {least} on each side": (
        "{photo}: hat {width} x {height} Pixel, erwartet mindestens {least} je Seite"
    ),
    "{photo}: {problem}": "{photo}: {problem}",
    "{photo}: {note}": "{photo}: {note}",
    "another photo has the same name; give each photo once, and another name to one of two": (
        "ein anderes Foto hat denselben Namen; jedes Foto einmal angeben, und einem von zweien einen anderen Namen"
    ),
    "shows {other}; too little of {scan} to take colors from": (
        "zeigt {other}; zu wenig von {scan}, um Farben daraus zu nehmen"
    ),
    "verified: {evidence}": "bestätigt: {evidence}",
    "verified with the help of {other}, which shows part of the same: {evidence}": (
        "bestätigt mit Hilfe von {other}, das einen Teil davon auch zeigt: {evidence}"
    ),
    "cannot be tested: {reason}": "nicht prüfbar: {reason}",
    "not verified: {reason}": "nicht bestätigt: {reason}",
    "{scan}: {photo} cannot be tested ({reason}); pick four to six pairs by hand to place it": (
        "{scan}: {photo} lässt sich nicht prüfen ({reason}); vier bis sechs Paare von Hand setzen, um es zu platzieren"
    ),
    "{scan}: {photo} could not be verified ({reason}); pick four to six pairs by hand to place it": (
        "{scan}: {photo} konnte nicht bestätigt werden ({reason}); vier bis sechs Paare von Hand setzen, um es zu "
        "platzieren"
    ),
    "{photo}: {count} pairs picked by hand do not place it, at least {least} do": (
        "{photo}: {count} von Hand gesetzte Paare genügen nicht, um es zu platzieren; nötig sind mindestens {least}"
    ),
    "{photo}: no camera sees the {count} pairs picked by hand where they are{off}; check them": (
        "{photo}: keine Kamera sieht die {count} von Hand gesetzten Paare, wo sie sind{off}; die Paare prüfen"
    ),
    " (off by {pixels} pixels)": " ({pixels} Pixel daneben)",
    ", pair {number} left out as wrong": ", Paar {number} als falsch ausgelassen",
    "{photo}: pair {number} (row {row}, column {col}) does not fit the others; its color is kept, check it": (
        "{photo}: Paar {number} (Zeile {row}, Spalte {col}) passt nicht zu den anderen; seine Farbe bleibt, das Paar "
        "prüfen"
    ),
    "nothing but the pairs speaks for it": "nichts außer den Paaren spricht dafür",
    "placed by {count} pairs picked by hand, off by {pixels} pixels{slips}; {evidence}": (
        "platziert durch {count} von Hand gesetzte Paare, {pixels} Pixel daneben{slips}; {evidence}"
    ),
    "the scan has {count} returns, at least {least} are needed": (
        "der Scan hat {count} Messungen, nötig sind mindestens {least}"
    ),
    "all returns of the scan are in one place": "alle Messungen des Scans liegen an einem Ort",
    "the scan has {count} parts to compare, at least {least} are needed": (
        "der Scan hat {count} vergleichbare Teile, nötig sind mindestens {least}"
    ),
    "the photo is of one tone": "das Foto ist einfarbig",
    "it shows nothing of the scan that could be found": "es zeigt nichts vom Scan, was sich finden ließe",
    "{count} of {all} parts of the scan agree with it": "{count} von {all} Teilen des Scans stimmen damit überein",
    "{count} of {all} parts of the scan agree with it, but would elsewhere as well": (
        "{count} von {all} Teilen des Scans stimmen damit überein, täten es aber anderswo genauso"
    ),
    "{note}; so placed, it shows nothing of the scan": "{note}; so platziert, zeigt es nichts vom Scan",
    "{scan}: {photo}, so placed, shows nothing of the scan; check the pairs, and add some far from the others": (
        "{scan}: {photo} zeigt, so platziert, nichts vom Scan; die Paare prüfen, und einige fern von den anderen "
        "hinzufügen"
    ),
    "{scan}: {photo}, so placed, shows nothing of the scan; pick four to six pairs by hand": (
        "{scan}: {photo} zeigt, so platziert, nichts vom Scan; vier bis sechs Paare von Hand setzen"
    ),
    "{scan}: no photo shows it; all its colors are guessed from the other scans": (
        "{scan}: kein Foto zeigt ihn; alle seine Farben sind aus den anderen Scans geraten"
    ),
    "{scan}: no photo could be verified, so there are no seeds; pick four to six pairs, or have colors guessed": (
        "{scan}: kein Foto konnte bestätigt werden, also gibt es keine Saatpunkte; vier bis sechs Paare setzen "
        "oder Farben raten lassen"
    ),
    "{scan}: no photo could be verified; colors are guessed from likeness, near the photos' mean color": (
        "{scan}: kein Foto konnte bestätigt werden; die Farben sind nach Ähnlichkeit geraten, nahe der "
        "mittleren Farbe der Fotos"
    ),
}

_REPORTS = {
    "a report in JSON": "ein Bericht in JSON",
    "the provenance is incomplete": "die Herkunftsangaben sind unvollständig",
    "the provenance is not JSON": "die Herkunftsangaben sind kein JSON",
    'the provenance is not of the format "{format}", version {version}': (
        'die Herkunftsangaben haben nicht das Format "{format}", Version {version}'
    ),
}

_RUNS = {
    "{scan}: its reflectance is the same everywhere, so that there is nothing to colorize it by; export it with "
    "intensity, or with colors": (
        "{scan}: seine Reflektanz ist überall gleich, sodass nichts zum Einfärben da ist; mit Intensität oder mit "
        "Farben exportieren"
    ),
    "{what}: {step} needs about {needed} of memory, and {free} are free; read every second row and column (step 2), or "
    "fewer scans at once": (
        "{what}: {step} braucht etwa {needed} Arbeitsspeicher, und {free} sind frei; jede zweite Zeile und Spalte "
        "lesen (Schrittweite 2), oder weniger Scans auf einmal"
    ),
    "finding seeds": "die Suche nach Saatpunkten",
    "colorizing": "das Einfärben",
    "making meshes": "das Erzeugen der Netze",
    "writing {name}": "das Schreiben von {name}",
    "{what} needs Blender; run the same as: blender -b --command reflcolor ...": (
        "{what} braucht Blender; dasselbe ausführen als: blender -b --command reflcolor ..."
    ),
    "{option} {path}: each of several scans has its own; write {placeholder} where its name is to stand, as in "
    "{example}": (
        "{option} {path}: jeder von mehreren Scans hat eine eigene; {placeholder} schreiben, wo sein Name stehen soll, "
        "wie in {example}"
    ),
    "{path}: holds no seeds; give at least one pixel with a color": (
        "{path}: enthält keine Saatpunkte; mindestens ein Pixel mit einer Farbe angeben"
    ),
    "{path}: no seed names this photo": "{path}: kein Saatpunkt nennt dieses Foto",
    "{path}: {problem}; expected seeds of the scan {scan}": ("{path}: {problem}; erwartet Saatpunkte des Scans {scan}"),
    "{path}: is given twice; give every file once": "{path}: ist zweimal angegeben; jede Datei einmal angeben",
    "--scan {wanted}: chooses a scan of one file, but {count} are given; leave it out to take every scan": (
        "--scan {wanted}: wählt einen Scan aus einer Datei, angegeben sind aber {count}; weglassen, um jeden Scan zu "
        "nehmen"
    ),
    "--seeds or --photo: give seeds, or photos to find them in{inside}": (
        "--seeds oder --photo: Saatpunkte angeben, oder Fotos, in denen sie zu finden sind{inside}"
    ),
    "; {file} holds {count} of its own: --photo {path}": "; {file} enthält selbst {count}: --photo {path}",
    "{option} {path}: the same file as {other_option} {other}; choose another name": (
        "{option} {path}: dieselbe Datei wie {other_option} {other}; einen anderen Namen wählen"
    ),
    "{option} {path}: is an input, and would be overwritten; choose another name": (
        "{option} {path}: wird gelesen und würde überschrieben; einen anderen Namen wählen"
    ),
    "{scan}: no photo could be verified, so there are no seeds; in Blender, click four to six points, each in the "
    "scan and in the photo, save them as seeds, and run seeds --hand; or take guessed colors with --guess": (
        "{scan}: kein Foto konnte bestätigt werden, also gibt es keine Saatpunkte; in Blender vier bis sechs Punkte "
        "anklicken, jeden im Scan und im Foto, sie als Saatpunkte speichern und seeds --hand aufrufen; oder mit "
        "--guess geratene Farben nehmen"
    ),
    "{file}: has {width} x {height} pixels, expected {columns} x {rows} as the scan {scan} has": (
        "{file}: hat {width} x {height} Pixel, erwartet {columns} x {rows} wie der Scan {scan}"
    ),
    "{option} {path}: the suffix tells what to write; expected one of {known}": (
        "{option} {path}: die Endung sagt, was geschrieben wird; erwartet eine von {known}"
    ),
    "--hand {path}: no scan has such a file; expected one of {expected}": (
        "--hand {path}: kein Scan hat eine solche Datei; erwartet eine von {expected}"
    ),
    "{path}: no such file; that scan gets no pairs picked by hand": (
        "{path}: keine solche Datei; dieser Scan bekommt keine von Hand gesetzten Paare"
    ),
    "{path} holds {count} scans": "{path} enthält {count} Scans",
    "--scan {wanted} means {count} of the scans in {path}": "--scan {wanted} meint {count} der Scans in {path}",
    "none": "keinen",
    "{problem}; choose one by --scan NAME or --scan INDEX: {listing}": (
        "{problem}; einen wählen mit --scan NAME oder --scan NUMMER: {listing}"
    ),
    "{problem}; choose one by --scan NAME or --scan INDEX: {listing}; --scan all takes every one": (
        "{problem}; einen wählen mit --scan NAME oder --scan NUMMER: {listing}; --scan all nimmt jeden"
    ),
    "{path}: no such file; expected the seeds of the scan {scan}": (
        "{path}: keine solche Datei; erwartet die Saatpunkte des Scans {scan}"
    ),
}

TEXTS = {**_SEEDS, **_MATCHING, **_REPORTS, **_RUNS}
