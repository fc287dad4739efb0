"""German: what the core says about images, outputs and files of any kind."""

_GATE = {
    "{file}: {reason}": "{file}: {reason}",
    "{file}: {problem}": "{file}: {problem}",
    "{file}: is {kind}, expected {expected}": "{file}: ist {kind}, erwartet {expected}",
    "a directory": "ein Ordner",
    "a pipe": "eine Pipe",
    "a socket": "ein Socket",
    "a device": "ein Gerät",
    "not an ordinary file": "keine gewöhnliche Datei",
    "an ordinary file": "eine gewöhnliche Datei",
    "an E57 file": "eine E57-Datei",
    "a PTX file": "eine PTX-Datei",
    "{file}: is empty, expected {expected}": "{file}: ist leer, erwartet {expected}",
    "{file}: has {size}, expected {expected} of at most {most}": (
        "{file}: hat {size}, erwartet {expected} von höchstens {most}"
    ),
    "{file}: cannot be read ({reason}); {way}": "{file}: kann nicht gelesen werden ({reason}); {way}",
    "no file has so long a name; check how it is spelled": (
        "keine Datei hat einen so langen Namen; die Schreibweise prüfen"
    ),
    "its links lead in a circle; name the file itself": "die Verknüpfungen führen im Kreis; die Datei selbst nennen",
    "a part of its path is no folder; check how it is spelled": (
        "ein Teil des Pfads ist kein Ordner; die Schreibweise prüfen"
    ),
    "close other programs": "andere Programme schließen",
    "files may not be larger here: raise the limit (ulimit -f), or choose another disk": (
        "Dateien dürfen hier nicht größer sein: die Grenze anheben (ulimit -f) oder einen anderen Datenträger wählen"
    ),
    "ask its owner for the right to read it": "den Besitzer um das Recht bitten, sie zu lesen",
    "copy it to another folder, and name the copy": "sie in einen anderen Ordner kopieren und die Kopie nennen",
    "{file}: is too large, expected {expected}": "{file}: ist zu groß, erwartet {expected}",
    "{file}: expected {expected}, found bytes that are not text": (
        "{file}: erwartet {expected}, gefunden Bytes, die kein Text sind"
    ),
    "{file}: line {line}, column {column}: expected {expected} ({problem})": (
        "{file}: Zeile {line}, Spalte {column}: erwartet {expected} ({problem})"
    ),
    "{file}: expected {expected}, found values that JSON cannot hold": (
        "{file}: erwartet {expected}, gefunden Werte, die JSON nicht enthalten kann"
    ),
    "{file}: does not fit into memory": "{file}: passt nicht in den Arbeitsspeicher",
    "{what} needs about {needed} of memory, and {free} are free": (
        "{what} braucht etwa {needed} Arbeitsspeicher, und {free} sind frei"
    ),
    "{what} needs about {needed} of memory, and {free} are free; {way}": (
        "{what} braucht etwa {needed} Arbeitsspeicher, und {free} sind frei; {way}"
    ),
    "its return numbers count from the farthest to the nearest; they were turned around": (
        "seine Echos sind vom fernsten zum nächsten gezählt; die Zählung wurde umgedreht"
    ),
    "{count:,} columns between its azimuths are missing; they were left empty": (
        "{count:,} Spalten zwischen seinen Azimuten fehlen; sie blieben leer"
    ),
    "read every second row and column only: --step 2, or Every in the import dialog": (
        "nur jede zweite Zeile und Spalte lesen: --step 2 oder Jede im Importdialog"
    ),
    "{file}: {width:,} x {height:,} pixels": "{file}: {width:,} x {height:,} Pixel",
    "{file}: {rows} x {columns} pixels": "{file}: {rows} x {columns} Pixel",
    "{file}: {count:,} points": "{file}: {count:,} Punkte",
    "{file}: {columns} columns x {rows} rows": "{file}: {columns} Spalten x {rows} Zeilen",
    "{file}: scan '{scan}': {count:,} points": "{file}: Scan '{scan}': {count:,} Punkte",
    "{file}: scan '{scan}': {rows} rows x {columns} columns": (
        "{file}: Scan '{scan}': {rows} Zeilen x {columns} Spalten"
    ),
    "not enough memory; close other programs, or read the scan with a larger step": (
        "nicht genug Arbeitsspeicher; andere Programme schließen, oder den Scan mit größerer Schrittweite lesen"
    ),
    "the current folder was deleted; change to another, or name files by their whole path": (
        "der aktuelle Ordner wurde gelöscht; in einen anderen wechseln, oder Dateien mit ihrem ganzen Pfad nennen"
    ),
    "the operating system reports: {reason}": "das Betriebssystem meldet: {reason}",
    "{package} is missing: another extension took it away; disable and enable Reflectance Colorizer": (
        "{package} fehlt: eine andere Erweiterung hat es weggenommen; Reflectance Colorizer aus- und einschalten"
    ),
}

_IMAGES = {
    "an EXR picture": "ein EXR-Bild",
    "an image (PNG, JPEG, TIFF, WebP, BMP or EXR)": "ein Bild (PNG, JPEG, TIFF, WebP, BMP oder EXR)",
    "{file}: its first bytes are not those of an EXR image": (
        "{file}: ihre ersten Bytes sind nicht die eines EXR-Bildes"
    ),
    "{file}: not a complete EXR image: it is damaged or cut short": (
        "{file}: kein vollständiges EXR-Bild: es ist beschädigt oder abgeschnitten"
    ),
    "{file}: is {kind}, expected an EXR of one part in scan lines": (
        "{file}: ist {kind}, erwartet ein EXR aus einem Teil in Bildzeilen"
    ),
    "tiled": "gekachelt",
    "deep": "ein tiefes Bild",
    "in several parts": "mehrteilig",
    "{file}: compressed with {found}, expected ZIP or none: save it that way": (
        "{file}: mit {found} komprimiert, erwartet ZIP oder keine Kompression: so speichern"
    ),
    "channel {name} of an EXR is subsampled, expected a value for every pixel": (
        "Kanal {name} eines EXR ist unterabgetastet, erwartet einen Wert für jedes Pixel"
    ),
    "{file}: is a HEIC photo, which is not supported; save it as JPEG or PNG (expected {expected})": (
        "{file}: ist ein HEIC-Foto, das nicht unterstützt wird; als JPEG oder PNG speichern (erwartet {expected})"
    ),
    "{file}: is not an image that can be read; expected {expected}": (
        "{file}: ist kein lesbares Bild; erwartet {expected}"
    ),
    "{file}: is not a whole {kind}: it is damaged or cut short": (
        "{file}: ist kein vollständiges {kind}: es ist beschädigt oder abgeschnitten"
    ),
    "{file}: claims to be {width:,} x {height:,} pixels, expected 1 to {most:,} in all; make it smaller": (
        "{file}: will {width:,} x {height:,} Pixel haben, erwartet 1 bis {most:,} insgesamt; verkleinern"
    ),
    "{file}: claims to be {width:,} x {height:,} pixels, more than the file can hold": (
        "{file}: will {width:,} x {height:,} Pixel haben, mehr, als die Datei enthalten kann"
    ),
    "{file}: its samples are signed, expected colors from 0 on; save the photo with 8 or 16 bits, unsigned": (
        "{file}: die Werte haben Vorzeichen, erwartet Farben ab 0; das Foto mit 8 oder 16 Bit ohne Vorzeichen speichern"
    ),
    "{file}: its color profile{name} consists of tables, which are not supported; its colors are taken as sRGB": (
        "{file}: das Farbprofil{name} besteht aus Tabellen, die nicht unterstützt werden; die Farben gelten als sRGB"
    ),
    "{file}: holds {count} pictures; the first was read": ("{file}: enthält {count} Bilder; das erste wurde gelesen"),
    "{file}: its color channels differ, expected a gray image with one value per pixel": (
        "{file}: die Farbkanäle sind verschieden, erwartet ein graues Bild mit einem Wert je Pixel"
    ),
    "{path}: cannot be encoded as {name} ({reason})": "{path}: kann nicht als {name} gespeichert werden ({reason})",
    "{file}: cannot be decoded ({reason})": "{file}: kann nicht dekodiert werden ({reason})",
    "{file}: cannot be decoded: it is damaged or cut short": (
        "{file}: kann nicht dekodiert werden: es ist beschädigt oder abgeschnitten"
    ),
    "{file}: is damaged ({reason})": "{file}: ist beschädigt ({reason})",
    "{file}: is damaged ({reason}); parts of it may be missing or wrong": (
        "{file}: ist beschädigt ({reason}); Teile können fehlen oder falsch sein"
    ),
    "{file}: holds no R, G, B or Y, found {found}": "{file}: enthält weder R, G, B noch Y, gefunden {found}",
    "{file}: holds no channel but alpha, expected one value per pixel": (
        "{file}: enthält keinen Kanal außer Alpha, erwartet einen Wert je Pixel"
    ),
    "{file}: its channels {found} differ, expected one value per pixel": (
        "{file}: die Kanäle {found} sind verschieden, erwartet einen Wert je Pixel"
    ),
}

_TIFF = {
    "{file}: not a whole TIFF: it is damaged or cut short": (
        "{file}: kein vollständiges TIFF: es ist beschädigt oder abgeschnitten"
    ),
    "{file}: not a whole TIFF: its tags are damaged or cut short": (
        "{file}: kein vollständiges TIFF: seine Tags sind beschädigt oder abgeschnitten"
    ),
    "{file}: is a TIFF with {found}, expected {expected}; save it as PNG, or as a plain TIFF": (
        "{file}: TIFF: gefunden {found}, erwartet {expected}; als PNG oder einfaches TIFF speichern"
    ),
    "a reduced image as its first one, as raw photos have": "ein verkleinertes erstes Bild, wie es Rohfotos haben",
    "a developed photo": "ein entwickeltes Foto",
    "bits in reversed order (fill order 2)": "Bits in umgekehrter Reihenfolge (fill order 2)",
    "the usual order": "die übliche Reihenfolge",
    "samples of several kinds": "Werte verschiedener Art",
    "the same bits and format for all": "gleiche Bits und gleiches Format für alle",
    "the compression {number}": "die Kompression {number}",
    "the photometric interpretation {number}": "die Farbdeutung (photometric) {number}",
    "gray or RGB": "Grau oder RGB",
    "{count} samples": "{count} Werte",
    "at least {count}": "mindestens {count}",
    "an alpha channel that is not one of its samples": "ein Alphakanal, der keiner der Werte ist",
    "one of them": "einer davon",
    "{bits} bits of the format {number}": "{bits} Bit im Format {number}",
    "8, 16, 32 or 64 bits, whole numbers or floating point": "8, 16, 32 oder 64 Bit, ganze Zahlen oder Gleitkomma",
    "white as zero in numbers without a greatest value": "Weiß als Null bei Zahlen ohne größten Wert",
    "black as zero": "Schwarz als Null",
    "the predictor {number}": "der Prädiktor {number}",
    "1, 2 or, for floating point, 3": "1, 2 oder, bei Gleitkomma, 3",
    "a palette, YCbCr or JPEG in an unusual layout": "Palette, YCbCr oder JPEG in ungewöhnlicher Anordnung",
    "a palette, YCbCr or JPEG that is turned": "Palette, YCbCr oder JPEG, gedreht",
    "an upright one": "ein aufrechtes Bild",
}

_WHOLE = {
    "{file}: was not written completely ({fault}); check whether the disk is full. Any earlier file was kept": (
        "{file}: wurde nicht vollständig geschrieben ({fault}); prüfen, ob der Datenträger voll ist. Eine frühere "
        "Datei ist erhalten"
    ),
    "it is empty": "sie ist leer",
    "there is no file": "es gibt keine Datei",
    "it is cut short or damaged": "sie ist abgeschnitten oder beschädigt",
    "it is cut short": "sie ist abgeschnitten",
    "it is cut short: {found:,} of {expected:,} bytes": "sie ist abgeschnitten: {found:,} von {expected:,} Bytes",
    "{count:,} bytes follow its end": "{count:,} Bytes folgen auf ihr Ende",
    "it is not a PNG": "sie ist kein PNG",
    "a checksum in it is wrong": "eine Prüfsumme darin ist falsch",
    "some of its pixels are missing": "ein Teil ihrer Pixel fehlt",
    "it is not a complete JPEG": "sie ist kein vollständiges JPEG",
    "its header is cut short": "ihr Kopf ist abgeschnitten",
    "it is not a PLY": "sie ist kein PLY",
    "{count:,} records are missing": "{count:,} Datensätze fehlen",
    "{count:,} lines of points are missing": "{count:,} Zeilen mit Punkten fehlen",
    "it is not an E57": "sie ist kein E57",
    "it has no description of what is in it": "ihr fehlt die Beschreibung ihres Inhalts",
    "it is not binary glTF": "sie ist kein binäres glTF",
    "{count:,} bytes of its data are missing": "{count:,} Bytes ihrer Daten fehlen",
    "it is not binary USD": "sie ist kein binäres USD",
    "its table of contents is damaged": "ihr Inhaltsverzeichnis ist beschädigt",
    "it is not a .blend file": "sie ist keine .blend-Datei",
    "a part of it is missing": "ein Teil von ihr fehlt",
    "it is damaged": "sie ist beschädigt",
    "it is not complete JSON text": "sie ist kein vollständiger JSON-Text",
}

_OUTPUTS = {
    "{file}: cannot be written ({reason}); {way}": "{file}: kann nicht geschrieben werden ({reason}); {way}",
    "choose a shorter name": "einen kürzeren Namen wählen",
    "make room on the disk, or choose another": "Platz auf dem Datenträger schaffen oder einen anderen wählen",
    "choose a folder that you may write to": "einen Ordner wählen, in den Sie schreiben dürfen",
    "choose another folder": "einen anderen Ordner wählen",
    "{file}: cannot be written: {reason}": "{file}: kann nicht geschrieben werden: {reason}",
    "see whether the disk is full": "prüfen, ob der Datenträger voll ist",
    "{file}: cannot be written: there is no folder {folder}; make it first": (
        "{file}: kann nicht geschrieben werden: es gibt keinen Ordner {folder}; ihn erst anlegen"
    ),
    "{file}: cannot be written: it is a directory; name a file": (
        "{file}: kann nicht geschrieben werden: das ist ein Ordner; eine Datei nennen"
    ),
    "{file}: cannot be written: it is not an ordinary file; name another": (
        "{file}: kann nicht geschrieben werden: das ist keine gewöhnliche Datei; eine andere nennen"
    ),
    "{file}: cannot be written: it exists and is write-protected; choose another name": (
        "{file}: kann nicht geschrieben werden: es gibt sie, und sie ist schreibgeschützt; einen anderen Namen wählen"
    ),
    "{file}: cannot be written as E57 ({reason})": "{file}: kann nicht als E57 geschrieben werden ({reason})",
    "{path}: cannot be written: E57 needs pye57, which is missing; write it as PTX": (
        "{path}: kann nicht geschrieben werden: E57 braucht pye57, das fehlt; als PTX schreiben"
    ),
    "{path}: {scan} has {rows} x {columns} pixels, E57 readers take at most {most} a side; write it as PTX": (
        "{path}: {scan} hat {rows} x {columns} Pixel, E57-Leser nehmen höchstens {most} je Seite; als PTX schreiben"
    ),
    "{path}: {scan} has no return; there is nothing to write": (
        "{path}: {scan} hat keine Messung; es gibt nichts zu schreiben"
    ),
    "{path}: {scan}: its pose is more than a rotation and a translation; write it as PTX": (
        "{path}: {scan}: seine Lage ist mehr als Drehung und Verschiebung; als PTX schreiben"
    ),
    "{file}: the field {field} of {source} holds text and could not be kept": (
        "{file}: das Feld {field} von {source} enthält Text und konnte nicht erhalten werden"
    ),
    "{file}: scan '{scan}': {count:,} of {all:,} points have no color: they are not part of its grid": (
        "{file}: Scan '{scan}': {count:,} von {all:,} Punkten haben keine Farbe: sie gehören nicht zu seinem Raster"
    ),
    "{path}: would have {size:.1f} GiB, and a GLB holds at most 4 GiB; make the mesh lighter with --faces, or write "
    ".ply or .blend": (
        "{path}: hätte {size:.1f} GiB, und ein GLB fasst höchstens 4 GiB; das Netz mit --faces leichter machen, oder "
        ".ply oder .blend schreiben"
    ),
    "{scan}: its points lie on no regular grid of angles; write it as PTX or E57": (
        "{scan}: seine Punkte liegen auf keinem regelmäßigen Winkelraster; als PTX oder E57 schreiben"
    ),
    "{path}: cannot be written: an image pair's name ends in {suffix}": (
        "{path}: kann nicht geschrieben werden: der Name eines Bildpaars endet auf {suffix}"
    ),
    "{scan}: too few returns to find the grid's angles; give azimuth_deg and elevation_deg": (
        "{scan}: zu wenige Messungen, um die Winkel des Rasters zu finden; azimuth_deg und elevation_deg angeben"
    ),
    "{path}: {count:,} returns are more than a PLY can number ({most:,}); write the scans one by one": (
        "{path}: {count:,} Messungen sind mehr, als ein PLY zählen kann ({most:,}); die Scans einzeln schreiben"
    ),
    "{file}: {source} has changed since its scans were read": (
        "{file}: {source} hat sich geändert, seit die Scans daraus gelesen wurden"
    ),
    "{file}: {count} lines at the end of {source} are not a complete scan or column; they were left out": (
        "{file}: {count} Zeilen am Ende von {source} sind kein vollständiger Scan und keine vollständige Spalte; sie "
        "wurden ausgelassen"
    ),
    "{file}: two of the scans are the same scan of {source}; it has room for one: export them one by one": (
        "{file}: zwei der Scans sind derselbe Scan von {source}, in dem nur für einen Platz ist: einzeln exportieren"
    ),
    "{file}: written anew, not copied from one {format} file: grid, points, reflectance, pose and name were kept, "
    "nothing else": (
        "{file}: neu geschrieben, nicht aus einer {format}-Datei kopiert: Raster, Punkte, Reflektanz, Lage und Name "
        "sind erhalten, sonst nichts"
    ),
    "Writing {name}": "{name} wird geschrieben",
    "wrote {path}": "{path} geschrieben",
    "wrote {path}: {count} seeds": "{path} geschrieben: {count} Saatpunkte",
}

TEXTS = {**_GATE, **_IMAGES, **_TIFF, **_WHOLE, **_OUTPUTS}
