// Nothing: targets that are compiled from this file alone hold precompiled headers for others.
