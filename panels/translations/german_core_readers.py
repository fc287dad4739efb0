"""German: what the readers say about scan files."""

_E57 = {
    "{file}: E57 needs pye57, which this platform has not; export the scan as PTX": (
        "{file}: E57 braucht pye57, das es auf dieser Plattform nicht gibt; den Scan als PTX exportieren"
    ),
    "{file}: E57 version {major}.{minor}, expected 1.0": "{file}: E57-Version {major}.{minor}, erwartet 1.0",
    "{file}: a checksum does not match: the file is damaged; copy or export it again": (
        "{file}: eine Prüfsumme stimmt nicht: die Datei ist beschädigt; neu kopieren oder exportieren"
    ),
    "{file}: cut short: {size} bytes, and an E57 header alone has {expected}": (
        "{file}: abgeschnitten: {size} Bytes, und allein der E57-Kopf hat {expected}"
    ),
    "{file}: cut short: {size} of {length} bytes; copy or export it again": (
        "{file}: abgeschnitten: {size} von {length} Bytes; neu kopieren oder exportieren"
    ),
    "{file}: data3D is not a list of scans; export it again": (
        "{file}: data3D ist keine Liste von Scans; neu exportieren"
    ),
    "{file}: holds no scan": "{file}: enthält keinen Scan",
    "{file}: holds {found:,} points where {count:,} were announced; it is damaged": (
        "{file}: enthält {found:,} Punkte, angekündigt sind {count:,}; die Datei ist beschädigt"
    ),
    "{file}: its XML section lies outside of the file; the file is damaged": (
        "{file}: ihr XML-Teil liegt außerhalb der Datei; die Datei ist beschädigt"
    ),
    "{file}: its header says pages of {page} bytes, expected {expected}; the file is damaged": (
        "{file}: der Kopf nennt Seiten von {page} Bytes, erwartet {expected}; die Datei ist beschädigt"
    ),
    "{file}: not an E57 file (it does not begin with ASTM-E57)": (
        "{file}: keine E57-Datei (sie beginnt nicht mit ASTM-E57)"
    ),
    "{file}: {size} bytes long, but its header says {length}; the file is damaged": (
        "{file}: {size} Bytes lang, aber ihr Kopf sagt {length}; die Datei ist beschädigt"
    ),
    "cannot be read: {kind} is read by a Python program of its own, and none was found beside Blender; "
    "export the scan as PTX": (
        "kann nicht gelesen werden: {kind} liest ein eigenes Python-Programm, und neben Blender ist keines zu finden; "
        "den Scan als PTX exportieren"
    ),
    "cannot be read: the program that reads {kind} did not start ({detail}); close other programs": (
        "kann nicht gelesen werden: das Programm für {kind} startete nicht ({detail}); andere Programme schließen"
    ),
    "takes longer to read, or more memory, than its size explains; export it again, or as PTX": (
        "braucht zum Lesen mehr Zeit oder Speicher, als ihre Größe erklärt; neu exportieren, oder als PTX"
    ),
    "was not read on for {detail}; see whether its disk answers, or export it again": (
        "wurde seit {detail} nicht weiter gelesen; prüfen, ob der Datenträger antwortet, oder neu exportieren"
    ),
    "what reads {kind} answered what makes no sense; export the file again": (
        "das Programm, das {kind} liest, gab eine unsinnige Antwort; die Datei neu exportieren"
    ),
    "what reads {kind} crashed on it; the file is damaged, or made to do harm; export it again": (
        "das Programm, das {kind} liest, ist daran abgestürzt; die Datei ist beschädigt oder bösartig; neu exportieren"
    ),
    "{file}: scan '{scan}': its row and column numbers span {rows:,} x {columns:,} pixels for {count:,} points; "
    "export it again as a gridded E57 or as PTX": (
        "{file}: Scan '{scan}': seine Zeilen- und Spaltennummern umspannen {rows:,} x {columns:,} Pixel für {count:,} "
        "Punkte; neu als E57 mit Raster oder als PTX exportieren"
    ),
    "{file}: scan '{scan}': rowIndex and columnIndex do not tell its points apart ({count:,} points, {pixels:,} "
    "pixels); export it as PTX or as a structured (gridded) E57, or {way}": (
        "{file}: Scan '{scan}': rowIndex und columnIndex unterscheiden seine Punkte nicht ({count:,} Punkte, "
        "{pixels:,} Pixel); als PTX oder strukturiertes E57 exportieren, oder {way}"
    ),
    "{file}: scan '{scan}': {field} holds values that are not whole numbers; export it as PTX": (
        "{file}: Scan '{scan}': {field} enthält Werte, die keine ganzen Zahlen sind; als PTX exportieren"
    ),
    "{file}: scan '{scan}' is unstructured (its points have no rowIndex and columnIndex); export it as PTX or as a "
    "structured (gridded) E57, or {way}": (
        "{file}: Scan '{scan}' ist unstrukturiert (seine Punkte haben weder rowIndex noch columnIndex); als PTX oder "
        "strukturiertes E57 exportieren, oder {way}"
    ),
    "{file}: LAS needs laspy, which is missing; export its points as E57": (
        "{file}: LAS braucht laspy, das hier fehlt; ihre Punkte als E57 exportieren"
    ),
    "{file}: LAZ needs lazrs, which is missing; export its points as LAS": (
        "{file}: LAZ braucht lazrs, das hier fehlt; ihre Punkte als LAS exportieren"
    ),
    "{file}: not a LAS file (it does not begin with LASF)": "{file}: keine LAS-Datei (sie beginnt nicht mit LASF)",
    "{file}: its header does not fit the file; it is damaged or cut short": (
        "{file}: ihr Kopf passt nicht zur Datei; sie ist beschädigt oder abgeschnitten"
    ),
    "{file}: its header is damaged ({reason})": "{file}: ihr Kopf ist beschädigt ({reason})",
    "{file}: its header says {count:,} points, expected 1 to {most:,}; export it again": (
        "{file}: ihr Kopf sagt {count:,} Punkte, erwartet 1 bis {most:,}; neu exportieren"
    ),
    "{file}: does not say how its points are compressed; it is damaged": (
        "{file}: sagt nicht, wie ihre Punkte komprimiert sind; sie ist beschädigt"
    ),
    "its points cannot be decompressed ({reason}); it is damaged or cut short: copy it again": (
        "ihre Punkte lassen sich nicht entpacken ({reason}); sie ist beschädigt oder abgeschnitten: neu kopieren"
    ),
    "announces {count:,} points, more than the file can hold; it is damaged": (
        "kündigt {count:,} Punkte an, mehr, als die Datei enthalten kann; sie ist beschädigt"
    ),
    "has texts where numbers are expected; export it again": ("hat Text, wo Zahlen erwartet werden; neu exportieren"),
    "has points of the type {kind}, which hold no records; export it again": (
        "hat Punkte vom Typ {kind}, der keine Datensätze enthält; neu exportieren"
    ),
    "does not fit into memory": "passt nicht in den Speicher",
    "has no points": "hat keine Punkte",
    "has no known coordinates, expected cartesianX, Y, Z or sphericalRange, Azimuth, Elevation": (
        "hat keine bekannten Koordinaten, erwartet cartesianX, Y, Z oder sphericalRange, Azimuth, Elevation"
    ),
    "its {field} is taken as the reflectance": "{field} wird als Reflektanz genommen",
    "{count:,} points without intensity were taken as no return": (
        "{count:,} Punkte ohne Intensität gelten als ohne Messung"
    ),
    "the intensity of {count:,} of its points is marked as invalid": (
        "die Intensität von {count:,} seiner Punkte ist als ungültig markiert"
    ),
    "its points have no rows and columns of their own, but follow each other in lines; these were taken": (
        "seine Punkte haben keine eigenen Zeilen und Spalten, folgen aber in Linien aufeinander; diese wurden genommen"
    ),
    "{count:,} points have spherical coordinates only; these were taken": (
        "{count:,} Punkte haben nur Kugelkoordinaten; diese wurden genommen"
    ),
    "{pixels:,} pixels have several returns; the first was taken, {count:,} others were left out": (
        "{pixels:,} Pixel haben mehrere Echos; das erste wurde genommen, {count:,} andere wurden ausgelassen"
    ),
    "{pixels:,} pixels have several returns; the strongest was taken, {count:,} others were left out": (
        "{pixels:,} Pixel haben mehrere Echos; das stärkste wurde genommen, {count:,} andere wurden ausgelassen"
    ),
    "{pixels:,} pixels have several returns; the last was taken, {count:,} others were left out": (
        "{pixels:,} Pixel haben mehrere Echos; das letzte wurde genommen, {count:,} andere wurden ausgelassen"
    ),
}

_E57_XML = {
    "its XML section has {size:,} bytes, expected at most {most:,}": (
        "der XML-Teil hat {size:,} Bytes, erwartet höchstens {most:,}"
    ),
    "its XML section is damaged; copy or export it again": (
        "der XML-Teil ist beschädigt; die Datei neu kopieren oder exportieren"
    ),
    "its XML section holds {what}, which no E57 has; it is not opened": (
        "der XML-Teil enthält {what}, was kein E57 hat; die Datei wird nicht geöffnet"
    ),
    "a document type": "einen Dokumenttyp",
    "an entity": "eine Entität",
    "a processing instruction": "eine Verarbeitungsanweisung",
    "its XML section is not XML 1.0 in UTF-8, as E57 has it": (
        "der XML-Teil ist kein XML 1.0 in UTF-8, wie E57 es verlangt"
    ),
    "its XML section has more than {most:,} nodes, or more than {deepest} inside each other": (
        "der XML-Teil hat mehr als {most:,} Knoten, oder mehr als {deepest} ineinander"
    ),
    "{node} has the type {kind}, which E57 does not define": "{node} hat den Typ {kind}, den E57 nicht kennt",
    "its XML section begins with {node}, expected e57Root": "der XML-Teil beginnt mit {node}, erwartet e57Root",
    "{node} holds {found}, expected a number": "{node} enthält {found}, erwartet eine Zahl",
    "{node} holds text, expected nodes": "{node} enthält Text, erwartet Knoten",
    "{node} holds more than {most:,} characters": "{node} enthält mehr als {most:,} Zeichen",
    "its XML section refers to something outside of it ({what}), which no E57 does; it is not opened": (
        "der XML-Teil verweist auf etwas außerhalb ({what}), was kein E57 tut; die Datei wird nicht geöffnet"
    ),
    "{node} has no {key}": "{node} hat kein {key}",
    "{node}: {key} is {found}, expected a whole number": "{node}: {key} ist {found}, erwartet eine ganze Zahl",
    "{node}: {key} is {found}, expected a number": "{node}: {key} ist {found}, erwartet eine Zahl",
    "{node} lies outside of the file": "{node} liegt außerhalb der Datei",
    "{node} lies inside of {parent}, which holds a value": "{node} liegt in {parent}, das einen Wert enthält",
    "{parent} holds {node}, expected prototype and codecs": "{parent} enthält {node}, erwartet prototype und codecs",
    "{parent} holds {node} twice": "{parent} enthält {node} zweimal",
    "{node} lies inside of a list that allows only children of one kind": (
        "{node} liegt in einer Liste, die nur Elemente einer Art erlaubt"
    ),
    "{node} has no prototype, which tells what its records hold": (
        "{node} hat keinen prototype, der sagt, was seine Datensätze enthalten"
    ),
    "{node}: its prototype holds something other than numbers": (
        "{node}: sein prototype enthält etwas anderes als Zahlen"
    ),
    "{node}: its codecs are not a list": "{node}: seine codecs sind keine Liste",
}

_E57_PHOTOS = {
    "it is {kind}; photos are compared with a scan as pinhole, spherical or visual reference images: export it as one "
    "of these, or straighten it and give the picture with --photo": (
        "es ist {kind}; Fotos werden als Lochkamera-, Kugel- oder Ansichtsbilder mit einem Scan verglichen: "
        "exportieren Sie es als eines davon, oder entzerren Sie es und geben Sie das Bild mit --photo an"
    ),
    "cylindrical": "zylindrisch",
    "unknown": "unbekannt",
    "{file}: holds no photo that can be used": "{file}: enthält kein Foto, das zu gebrauchen ist",
    "{file}: its photo {photo} is left out: {reason}": "{file}: ihr Foto {photo} wird ausgelassen: {reason}",
    "a checksum does not match: the file is damaged; copy or export it again": (
        "eine Prüfsumme stimmt nicht: die Datei ist beschädigt; neu kopieren oder exportieren"
    ),
    "it lies outside of the file; the file is damaged": "es liegt außerhalb der Datei; die Datei ist beschädigt",
}

_PTX = {
    "line {line}: what follows its last scan is not a scan and was left out: '{found}'": (
        "Zeile {line}: was auf den letzten Scan folgt, ist kein Scan und wurde ausgelassen: '{found}'"
    ),
    "its scan {number} was left out: {reason}": "Scan {number} wurde ausgelassen: {reason}",
    "{file}: holds no text, expected the header of a PTX scan": (
        "{file}: enthält keinen Text, erwartet den Kopf eines PTX-Scans"
    ),
    "{columns} columns x {rows} rows announced, but the rest of the file ({left} bytes) has room for at most {most} "
    "points; it is cut short, or its header is wrong": (
        "{columns} Spalten x {rows} Zeilen angekündigt, aber der Rest der Datei ({left} Bytes) hat Platz für höchstens "
        "{most} Punkte; sie ist abgeschnitten, oder ihr Kopf ist falsch"
    ),
    "the file ends after {at} of {count} points ({columns} columns x {rows} rows); it is cut short": (
        "die Datei endet nach {at} von {count} Punkten ({columns} Spalten x {rows} Zeilen); sie ist abgeschnitten"
    ),
    "{reason}; its complete columns were read": "{reason}; die vollständigen Spalten wurden gelesen",
    "its points follow each other in lines of {length}, not of {rows} as its header says; they were read that way": (
        "seine Punkte folgen in Linien von {length} aufeinander, nicht von {rows}, wie der Kopf sagt; sie wurden so "
        "gelesen"
    ),
    "{count:,} points have no color although others do; they are black": (
        "{count:,} Punkte haben keine Farbe, obwohl andere eine haben; sie sind schwarz"
    ),
    "expected 4 or 7 values, found {found}": "erwartet 4 oder 7 Werte, gefunden {found}",
    "the file ends where {what} was expected; it is cut short": (
        "die Datei endet, wo {what} zu erwarten ist; sie ist abgeschnitten"
    ),
    "the number of rows": "die Zahl der Zeilen",
    "the scanner's position": "der Standpunkt des Scanners",
    "a scanner axis": "eine Achse des Scanners",
    "a row of the matrix": "eine Zeile der Matrix",
    "expected the end of the file or the number of columns of the next scan, found '{found}'": (
        "erwartet das Ende der Datei oder die Zahl der Spalten des nächsten Scans, gefunden '{found}'"
    ),
    "expected the number of {what} (a whole number above 0), found '{found}'": (
        "erwartet die Zahl der {what} (eine ganze Zahl über 0), gefunden '{found}'"
    ),
    "columns": "Spalten",
    "rows": "Zeilen",
    "expected {what} ({count} numbers), found {found}": "erwartet {what} ({count} Zahlen), gefunden {found}",
    "expected a number, found '{found}'": "erwartet eine Zahl, gefunden '{found}'",
}

_POSES = {
    "its matrix is corrupt (expected finite numbers and 0 0 0 1 as its last column)": (
        "seine Matrix ist fehlerhaft (erwartet endliche Zahlen und 0 0 0 1 als letzte Spalte)"
    ),
    "its matrix is singular, or its scale is not plausible": (
        "seine Matrix ist singulär, oder ihr Maßstab ist nicht plausibel"
    ),
    "the identity is used: place the scan by hand": ("die Einheitsmatrix wird verwendet: den Scan von Hand platzieren"),
    "its position and axes are used": "Standpunkt und Achsen werden verwendet",
    "{fault}; {instead}": "{fault}; {instead}",
    "its matrix scales, shears or mirrors; it is used as it is": (
        "seine Matrix skaliert, schert oder spiegelt; sie wird verwendet, wie sie ist"
    ),
    "its scanner axes are not a rotation; the matrix is used": (
        "die Achsen des Scanners sind keine Drehung; die Matrix wird verwendet"
    ),
    "its scanner position {position} is not the matrix's {other}; the matrix is used": (
        "der Standpunkt {position} des Scanners ist nicht der der Matrix, {other}; die Matrix wird verwendet"
    ),
    "its scanner axes are not those of the matrix; the matrix is used": (
        "die Achsen des Scanners sind nicht die der Matrix; die Matrix wird verwendet"
    ),
    "its rotation {rotation} is corrupt; no rotation is used": (
        "seine Drehung {rotation} ist fehlerhaft; es wird keine verwendet"
    ),
    "its rotation is a quaternion of length {length:.6g}, brought to 1": (
        "seine Drehung ist ein Quaternion der Länge {length:.6g}, auf 1 gebracht"
    ),
    "its translation {translation} is corrupt; no translation is used": (
        "seine Verschiebung {translation} ist fehlerhaft; es wird keine verwendet"
    ),
    "its matrix scales by {scale:g}, which would put its points {distance:.3g} m away; the scale was left out": (
        "seine Matrix skaliert um {scale:g}, womit seine Punkte {distance:.3g} m entfernt wären; die Skalierung wurde "
        "weggelassen"
    ),
    "its matrix scales by {scale:g}: its points are {scale:g} times as far away": (
        "seine Matrix skaliert um {scale:g}: seine Punkte sind {scale:g}-mal so weit entfernt"
    ),
}

_SETTLED = {
    "{count:,} pixels repeat one and the same point, {place}, and were taken as no return": (
        "{count:,} Pixel wiederholen denselben Punkt, {place}, und gelten als ohne Messung"
    ),
    "its row numbers go up by {rows} and its column numbers by {columns}; the gaps were closed": (
        "seine Zeilennummern steigen um {rows}, seine Spaltennummern um {columns}; die Lücken wurden geschlossen"
    ),
    "was thinned out: {share:.0%} of its pixels hold a point; {stride} x {stride} of them were made one, and {lost:,} "
    "points left out": (
        "wurde ausgedünnt: {share:.0%} seiner Pixel haben einen Punkt; je {stride} x {stride} wurden zu einem, und "
        "{lost:,} Punkte ausgelassen"
    ),
    "its coordinates count millimeters; they were brought to meters": (
        "seine Koordinaten zählen Millimeter; sie wurden in Meter umgerechnet"
    ),
    "its points are in world coordinates already; its pose is not applied to them again": (
        "seine Punkte stehen schon in Weltkoordinaten; seine Lage wird nicht noch einmal angewandt"
    ),
    "its points were not measured from the scanner; it stood at {place}, as {source} shows, and ranges count from "
    "there": (
        "seine Punkte waren nicht vom Scanner aus gemessen; er stand bei {place}, wie {source} zeigt, und Entfernungen "
        "zählen von dort"
    ),
    "the position in its header": "der Standpunkt in seinem Kopf",
    "the point that its pixels without a return repeat": "der Punkt, den seine Pixel ohne Messung wiederholen",
    "the regularity of its rows and columns": "die Regelmäßigkeit seiner Zeilen und Spalten",
    "every point is more than {distance:,.0f} km from the scanner's origin: the file holds world coordinates, so "
    "ranges and orientation mean little; rows and columns stay as stored": (
        "jeder Punkt ist mehr als {distance:,.0f} km vom Ursprung des Scanners entfernt: die Datei enthält "
        "Weltkoordinaten, Entfernungen und Ausrichtung sagen daher wenig; Zeilen und Spalten bleiben wie gespeichert"
    ),
    "its points do not show which way is up; turn or flip it if it looks wrong": (
        "seine Punkte zeigen nicht, wo oben ist; drehen oder spiegeln, wenn er falsch aussieht"
    ),
    "its rows and columns are swapped in the file; they were swapped back": (
        "seine Zeilen und Spalten sind in der Datei vertauscht; sie wurden zurückgetauscht"
    ),
    "its pose says that the scanner hung upside down or lay on its side; row 0 is what was up in the world": (
        "nach seiner Lage hing der Scanner kopfüber oder lag auf der Seite; Zeile 0 ist, was in der Welt oben war"
    ),
}

TEXTS = {**_E57, **_E57_XML, **_E57_PHOTOS, **_PTX, **_POSES, **_SETTLED}
