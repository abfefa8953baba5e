"""The judge of fields on meshes: any points, faces or nodes of another program, against the scene's right answer."""
from .command import answer
from .field import ContactField
from .read import read

__all__ = ["answer", "ContactField", "read"]
