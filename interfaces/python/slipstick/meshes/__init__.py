"""The judge of fields on meshes: any points, faces or nodes of another program, against the scene's right answer."""
