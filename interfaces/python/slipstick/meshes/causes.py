"""Likely causes of a bad field on a mesh."""
def causes_of(examined, request):
    return []
