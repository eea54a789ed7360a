# Writes the shader files as one table of C++ raw strings, so that the program needs no files beside it.
set(text "#include \"shaders/shader_source.h\"\n\nnamespace pellucid {\nconst ShaderText kShaderTexts[] = {\n")
foreach(file IN LISTS FILES)
  file(READ ${ROOT}/${file} body)
  string(APPEND text "{\"${file}\", R\"pld~(${body})pld~\"},\n")
endforeach()
string(APPEND text "{nullptr, nullptr}};\n}  // namespace pellucid\n")
file(WRITE ${OUT} "${text}")
