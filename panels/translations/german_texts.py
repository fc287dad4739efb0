"""German: what panels say, what operators report, and what is missing for them."""

_PANELS = {
    "Cancelling": "Wird abgebrochen",
    "Click scan, then photo, or choose a color": "Scan, dann Foto anklicken, oder Farbe wählen",
    "Color": "Farbe",
    "Colorize first": "Erst einfärben",
    "Colors of unknown origin": "Farben unbekannter Herkunft",
    "Deleted image": "Gelöschtes Bild",
    "ESC: Cancel": "ESC: Abbrechen",
    "Evaluate first": "Erst bewerten",
    "Evidence": "Beleg",
    "For a range and a reflectance image picked together": "Für ein Entfernungs- und ein Reflektanzbild zusammen",
    "Import a scan, or select one": "Scan importieren oder auswählen",
    "Import it again": "Noch einmal importieren",
    "Inference": "Schluss",
    "Inputs (SHA-256)": "Eingaben (SHA-256)",
    "Its colors are guesses": "Seine Farben sind geraten",
    "Maps show in Solid shading": "Karten zeigen sich in der Schattierung Solide",
    "{names} missing": "{names} fehlt",
    "Needs a scan": "Braucht einen Scan",
    "Delete": "Löschen",
    "Let Go": "Loslassen",
    "Move or Stroke": "Ziehen oder Strich",
    "Seed or Color": "Saatpunkt oder Farbe",
    "Select": "Auswählen",
    "Take Color": "Farbe nehmen",
    "the mesh could not be made lighter ({reason})": "das Netz konnte nicht leichter gemacht werden ({reason})",
    "the mesh could not be made lighter: Blender did not start ({reason})": (
        "das Netz konnte nicht leichter gemacht werden: Blender startete nicht ({reason})"
    ),
    "the mesh could not be made lighter: Blender ended with {status} ({reason}); it may have run out of memory: read "
    "every second row and column (step 2)": (
        "das Netz konnte nicht leichter gemacht werden: Blender endete mit {status} ({reason}); vielleicht reichte der "
        "Arbeitsspeicher nicht: nur jede zweite Zeile und Spalte lesen (Schritt 2)"
    ),
    "This is a light mesh; select the scan itself": "Das ist ein leichtes Netz; den Scan selbst auswählen",
    "{name}: is a light mesh, which can be shown and exported; select the scan itself": (
        "{name}: ist ein leichtes Netz, das gezeigt und exportiert werden kann; den Scan selbst auswählen"
    ),
    "The scan is linked from another file; make it local or a library override first": (
        "Der Scan ist aus einer anderen Datei verknüpft; erst lokal machen oder eine Bibliotheksüberschreibung anlegen"
    ),
    "Needs seeds": "Braucht Saatpunkte",
    "Looks flat? Lower it for detail": "Zu flach? Weniger zeigt Details",
    "No seed reaches": "Von keinem erreicht",
    "None in the scan": "Nicht im Scan",
    "None: all colors are guesses": "Keine: alle Farben sind geraten",
    "Not known": "Nicht bekannt",
    "Not recognized? Pick 4 to 6 seeds": "Nicht erkannt? 4 bis 6 Saatpunkte",
    "Another mesh was joined to it": "Ein anderes Netz wurde damit verbunden",
    "Renders keep each one's colors": "Renderbilder behalten die Farben von jedem",
    "Match the photo first": "Erst das Foto zuordnen",
    "Not found on this scan": "Auf diesem Scan nicht gefunden",
    "Not matched with this scan": "Diesem Scan nicht zugeordnet",
    "Set Up Render again to show this": "Noch einmal „Bild einrichten“, um dies zu zeigen",
    "photo {number}": "Foto {number}",
    "{name}: leave Edit Mode first": "{name}: zuerst den Bearbeitungsmodus verlassen",
    "scanner: the scene has no camera; choose where else the scanner stands": (
        "Scanner: die Szene hat keine Kamera; einen anderen Ort für den Scanner wählen"
    ),
    "scanner: no object is active; choose where else the scanner stands": (
        "Scanner: kein Objekt ist aktiv; einen anderen Ort für den Scanner wählen"
    ),
    "{file}: the suffix tells what to write; expected .ptx, .e57 or .scan.json": (
        "{file}: die Endung bestimmt, was geschrieben wird; erwartet .ptx, .e57 oder .scan.json"
    ),
    "camera {name}: is no perspective camera of the scene {scene}": (
        "Kamera {name}: ist keine perspektivische Kamera der Szene {scene}"
    ),
    "{file}: Blender could not read it; expected a file saved by Blender": (
        "{file}: Blender konnte sie nicht lesen; erwartet eine von Blender gesicherte Datei"
    ),
    "{file}: Blender could not open it: {reason}": "{file}: Blender konnte sie nicht öffnen: {reason}",
    "Row {row}, column {col}": "Zeile {row}, Spalte {col}",
    "Seed": "Saatpunkt",
    "Seed Color": "Farbe der Saatpunkte",
    "Sure": "Sicher",
    "The scan came without colors": "Der Scan kam ohne Farben",
    "Verified on this scan": "Auf diesem Scan bestätigt",
    "{percent:.0%} (ESC cancels)": "{percent:.0%} (ESC bricht ab)",
    "{place}: choose its color": "{place}: Farbe wählen",
    "Seed {number}": "Saatpunkt {number}",
    "Photo {number}": "Foto {number}",
    "Make Light Mesh": "Leichtes Netz erzeugen",
    "{name} is gone; its light mesh was dropped": "{name} gibt es nicht mehr; das leichte Netz wurde verworfen",
    "{name} has {faces} faces instead of {whole}; {scan} is hidden": (
        "{name} hat {faces} Flächen statt {whole}; {scan} ist ausgeblendet"
    ),
    "Make Texture": "Textur erzeugen",
    "{name} has a texture of {columns} x {rows} pixels": "{name} hat eine Textur von {columns} x {rows} Pixeln",
    "Inferred": "Erschlossen",
    "{count} pixels as {photo} shows them": "{count} Pixel, wie {photo} sie zeigt",
    "Select Seeds": "Saatpunkte auswählen",
    "and {count} more": "und {count} weitere",
    "not kept": "nicht vermerkt",
    "with a photo point ({count} so far)": "mit Fotopunkt setzen (bisher {count})",
    "{count} more warnings": "{count} weitere Warnungen",
    "{count} pixels colored from them": "{count} Pixel daraus eingefärbt",
    "{count} pixels left gray": "{count} Pixel grau gelassen",
    "{count} seeds found by a photo's camera": "{count} Saatpunkte durch die Kamera eines Fotos",
    "{count} seeds found by a photo's homography": "{count} Saatpunkte durch die Homographie eines Fotos",
    "{count} seeds found by likeness": "{count} Saatpunkte durch Ähnlichkeit",
    "{count} seeds in the scan's own colors": "{count} Saatpunkte in den Farben des Scans selbst",
    "{count} seeds picked in a photo": "{count} Saatpunkte aus einem Foto gepickt",
    "{count} seeds with a color given by hand": "{count} Saatpunkte mit Farbe von Hand",
    "{count} scans selected": "{count} Scans ausgewählt",
    "{cols} x {rows} pixels, {returns} returns": "{cols} x {rows} Pixel, {returns} Messungen",
    "{shown} of {count}": "{shown} von {count}",
}

_JOBS = {
    "Colorize": "Einfärben",
    "Evaluate": "Bewerten",
    "Export Colorized Scan": "Gefärbten Scan exportieren",
    "Import Laser Scan": "Laserscan importieren",
    "Match Photos": "Fotos zuordnen",
    "Simulate Laser Scan": "Laserscan simulieren",
    "Move Seeds or Stroke": "Saatpunkte ziehen oder Strich",
    "Set Up Render": "Bild einrichten",
    "Load Photo": "Foto laden",
    "Load Seeds": "Saatpunkte laden",
}

_MISSING = {
    "Add a seed first": "Erst einen Saatpunkt hinzufügen",
    "Colorize the scan first": "Erst den Scan einfärben",
    "Give a seed its color first": "Erst einem Saatpunkt seine Farbe geben",
    "Import a scan, and show its reflectance image or a photo here": (
        "Einen Scan importieren und hier sein Reflektanzbild oder ein Foto zeigen"
    ),
    "Import a scan, or select one, first": "Erst einen Scan importieren oder auswählen",
    "Leave Edit Mode first": "Erst den Bearbeitungsmodus verlassen",
    "Load a photo first": "Erst ein Foto laden",
    "Open Seed Picking first": "Erst die Saatpunktauswahl öffnen",
    "Pick a color first": "Erst eine Farbe aufnehmen",
    "Run this in Blender's window": "Nur in Blenders Fenster möglich",
    "Select a seed first": "Erst einen Saatpunkt auswählen",
    "The mesh is linked from another file; make it local first": (
        "Das Netz ist aus einer anderen Datei verknüpft; erst lokal machen"
    ),
    "Nothing is missing": "Nichts fehlt",
    "There are no messages": "Es gibt keine Meldungen",
    "Turn Live Update on first": "Erst die Live-Aktualisierung einschalten",
}

_REPORTS = {
    "Click on the scan to place a seed": "Auf den Scan klicken, um einen Saatpunkt zu setzen",
    "Took {count} seeds from the colors of {name}": "{count} Saatpunkte aus den Farben von {name} genommen",
    "{name}: another mesh was joined to the scan; undo that, or separate them by material": (
        "{name}: ein anderes Netz wurde mit dem Scan verbunden; das rückgängig machen oder sie nach Material trennen"
    ),
    "the example is not there: {path}; install the extension again": (
        "das Beispiel ist nicht da: {path}; die Erweiterung neu installieren"
    ),
    "the example: {reason}": "das Beispiel: {reason}",
    "without the detail of {photos}: not among the images any more": (
        "ohne die Einzelheiten von {photos}: nicht mehr unter den Bildern"
    ),
    "Loading {file}": "{file} wird geladen",
    "{file}: cannot be written ({reason}); choose another folder": (
        "{file}: nicht zu schreiben ({reason}); einen anderen Ordner wählen"
    ),
    "Cycles is not there to cast rays; enable Cycles Render Engine among the add-ons": (
        "Cycles fehlt, um Strahlen zu verfolgen; Cycles Render Engine unter den Add-ons einschalten"
    ),
    "Click on {name}": "Auf {name} klicken",
    "Colorized {count} scans: {names}": "{count} Scans eingefärbt: {names}",
    "Colorized {name} from {count} seeds": "{name} aus {count} Saatpunkten eingefärbt",
    "Copied the report to the clipboard": "Bericht in die Zwischenablage kopiert",
    "Deleted {count} seeds": "{count} Saatpunkte gelöscht",
    "Exported {path}": "{path} exportiert",
    "{file}: the suffix tells what to write; expected one of {known}": (
        "{file}: die Endung sagt, was geschrieben wird; erwartet: eine von {known}"
    ),
    "{object}: cannot be exported ({reason})": "{object}: kann nicht exportiert werden ({reason})",
    "Found seeds for {count} scans: {counts}": "Saatpunkte für {count} Scans gefunden: {counts}",
    "Found {count} seeds for {name}": "{count} Saatpunkte für {name} gefunden",
    "Imported {name}": "{name} importiert",
    "{file} holds {count} photos; Load Photo puts all of them on the list": (
        "{file} enthält {count} Fotos; Foto laden setzt sie alle auf die Liste"
    ),
    "photo: {image}": "Foto: {image}",
    "Photos inside {name}, now on the list of photos: {count}": (
        "Fotos in {name}, jetzt auf der Liste der Fotos: {count}"
    ),
    "Loaded {count} seeds": "{count} Saatpunkte geladen",
    "Loaded {name}: {width} x {height} pixels": "{name} geladen: {width} x {height} Pixel",
    "No return there; placed at row {row}, column {col}": "Dort keine Messung; gesetzt in Zeile {row}, Spalte {col}",
    "Saved {count} seeds to {path}": "{count} Saatpunkte gespeichert in {path}",
    "Simulated {path}": "{path} simuliert",
    "That seed was moved or removed": "Dieser Saatpunkt wurde versetzt oder entfernt",
    "The reflectance image was deleted; undo that, or import the scan again": (
        "Das Reflektanzbild wurde gelöscht; das rückgängig machen oder den Scan noch einmal importieren"
    ),
    "a photo of the list cannot be read; remove it and load it again": (
        "ein Foto der Liste ist nicht lesbar; es entfernen und neu laden"
    ),
    "photo {photo} has no color at {x:g}, {y:g}; load the photo, pick inside it": (
        "Foto {photo} hat keine Farbe bei {x:g}, {y:g}; das Foto laden, darin aufnehmen"
    ),
    "row {row}, column {col} is outside the scan's grid (rows 0 to {last_row}, columns 0 to {last_col})": (
        "Zeile {row}, Spalte {col} liegt außerhalb des Scans (Zeilen 0 bis {last_row}, Spalten 0 bis {last_col})"
    ),
    "there is no image {name}; open it first": "es gibt kein Bild {name}; es erst öffnen",
    "there is no seed {index}; the scan has seeds 0 to {last}": (
        "es gibt keinen Saatpunkt {index}; der Scan hat die Saatpunkte 0 bis {last}"
    ),
    "{image}: is {width} x {height} pixels, but the scan {name} has {cols} columns x {rows} rows; "
    "they must be the same": (
        "{image}: hat {width} x {height} Pixel, aber der Scan {name} hat {cols} Spalten x {rows} Zeilen; "
        "beide müssen gleich sein"
    ),
    "{name} cancelled; nothing was changed": "{name} abgebrochen; nichts wurde geändert",
    "{name} is gone; its colors were dropped": "{name} ist nicht mehr da; die Farben wurden verworfen",
    "{name} is gone; its errors were dropped": "{name} ist nicht mehr da; die Fehler wurden verworfen",
    "{name} is gone; its seeds were dropped": "{name} ist nicht mehr da; die Saatpunkte wurden verworfen",
    "{name} is gone; the render was not set up": "{name} ist weg; das Rendern wurde nicht eingerichtet",
    "{name} is not in this view layer": "{name} ist nicht in dieser Ansichtsebene",
    "{name} is still running; press ESC to cancel it": "{name} läuft noch; ESC bricht es ab",
    "{name} was left out: {reason}": "{name} wurde ausgelassen: {reason}",
    "{name}: mean CIEDE2000 {mean:.2f}, below {percentile:.2f} at 95 % of {count} vertices; "
    "with the true luminance {alone:.2f}": (
        "{name}: CIEDE2000 {mean:.2f} im Mittel, unter {percentile:.2f} an 95 % von {count} Vertices; "
        "mit der wahren Helligkeit {alone:.2f} im Mittel"
    ),
    "{name}: grid_row and grid_col point outside the scan; import the scan again": (
        "{name}: grid_row und grid_col zeigen aus dem Scan hinaus; den Scan noch einmal importieren"
    ),
    "{name}: no pixel has a return, so no seed can be placed": (
        "{name}: kein Pixel hat eine Messung, also kann kein Saatpunkt gesetzt werden"
    ),
    "{name}: not all was written, because a scan was undone or removed meanwhile": (
        "{name}: Nicht alles wurde geschrieben, weil ein Scan inzwischen rückgängig gemacht oder entfernt wurde"
    ),
    "{name}: pick two images together, one of range and one of reflectance, and a third of colors if there is one": (
        "{name}: zwei Bilder zusammen auswählen, eines der Entfernung und eines der Reflektanz, und ein drittes der "
        "Farben, wenn es eines gibt"
    ),
    "{name}: the scan came without colors; choose an image of its true colors": (
        "{name}: der Scan kam ohne Farben; ein Bild seiner wahren Farben wählen"
    ),
    "{name}: the scan has no points to show": "{name}: der Scan hat keine Punkte zu zeigen",
    "{object}: the mesh has lost its attribute {name}; undo what removed it, or import again": (
        "{object}: das Netz hat sein Attribut {name} verloren; rückgängig machen oder noch einmal importieren"
    ),
    "{object}: the mesh has no color attribute {name} with one color per vertex": (
        "{object}: das Netz hat kein Farbattribut {name} mit einer Farbe je Vertex"
    ),
}

MESSAGES = {("*", text): german for texts in (_PANELS, _JOBS, _MISSING, _REPORTS) for text, german in texts.items()}
