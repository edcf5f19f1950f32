namespace impinge {
const char* version() { return IMPINGE_VERSION; }
}  // namespace impinge
