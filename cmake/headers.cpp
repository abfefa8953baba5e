// An empty source: some targets compile only this file, to provide precompiled headers for others.
