# The target reference: pages of docs/reference that are made from the program itself. They are committed, and a test
# holds them to the program.
add_custom_target(reference
  COMMAND slipstick reference ${PROJECT_SOURCE_DIR}/docs/reference
  COMMENT "Writing docs/reference" VERBATIM)
