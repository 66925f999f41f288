# Writes OUTPUT, a source file that defines the contents of FILES by their names relative to FOLDER
# (shader_library.cpp declares it). Compilers limit the length of a literal; a shader is far below.
set(rows "")
foreach(file ${FILES})
  file(RELATIVE_PATH name ${FOLDER} ${file})
  file(READ ${file} text)
  string(APPEND rows "    {\"${name}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"render/shader_library.h\"\n
namespace tessera::render {\n
const std::map<std::string_view, std::string_view>& embeddedShaders() {
    static const std::map<std::string_view, std::string_view> kShaders{
${rows}    };
    return kShaders;
}\n
}  // namespace tessera::render\n")
