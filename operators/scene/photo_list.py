"""The list of photos: that of the scene or, as long as it has none of its own, that of another scene of the file."""

import bpy


def photo_settings(scene):
    """Return the settings that hold the photos for a scene: ``photos`` and ``active_photo``."""
    others = (other for other in bpy.data.scenes if other.reflcolor.photos)
    return scene.reflcolor if scene.reflcolor.photos else next(others, scene).reflcolor


def listed_images(scene):
    """Return the images of the photos for a scene, in their order."""
    return [photo.image for photo in photo_settings(scene).photos if photo.image is not None]


def active_image(scene):
    """Return the image of the photo that is selected in the list; None where there is none."""
    settings = photo_settings(scene)
    number = settings.active_photo
    return settings.photos[number].image if 0 <= number < len(settings.photos) else None


def list_photo(scene, image):
    """Put an image on the list, where it is not yet, and select it there."""
    settings = photo_settings(scene)
    listed = [photo.image for photo in settings.photos]
    if image not in listed:
        settings.photos.add().image = image
        listed.append(image)
    settings.active_photo = listed.index(image)
