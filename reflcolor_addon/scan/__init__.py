"""A scan and its geometry: orientation, normalization, normals, the mesh of its grid."""
