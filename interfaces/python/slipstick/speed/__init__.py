"""Times of programs that use Google Benchmark: reading, comparison, growth with the mesh, speed against error."""
