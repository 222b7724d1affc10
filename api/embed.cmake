# SPDX-License-Identifier: Apache-2.0
# tinsmith_embed(TARGET FUNCTION FILE...): compiles the texts of the files into TARGET, as
#     std::span<const EmbeddedFile> FUNCTION()        (api/embedded_file.hpp declares both)
# in the namespace tinsmith. A file that changes is embedded anew by the next build.
if(NOT CMAKE_SCRIPT_MODE_FILE)
    function(tinsmith_embed target function)
        set(script ${CMAKE_CURRENT_FUNCTION_LIST_FILE})
        set(made ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
        add_custom_command(OUTPUT ${made}
            COMMAND ${CMAKE_COMMAND} -D "made=${made}" -D "function=${function}" -D "files=${ARGN}"
                -P ${script}
            DEPENDS ${ARGN} ${script}
            COMMENT "Embedding ${function}" VERBATIM)
        target_sources(${target} PRIVATE ${made})
    endfunction()
    return()
endif()

# Below: `cmake -P`, at build time. Compilers need not take longer literals than this.
set(longest 65536)
set(text "// Made by api/embed.cmake.\n#include <array>\n\n#include \"api/embedded_file.hpp\"\n\nnamespace tinsmith {\n\n")
string(APPEND text "std::span<const EmbeddedFile> ${function}() {\n    static constexpr std::array kFiles{\n")
foreach(file IN LISTS files)
    file(READ ${file} content)
    string(LENGTH "${content}" length)
    if(length GREATER longest)
        message(FATAL_ERROR "${file} is too long to be embedded: split it")
    endif()
    get_filename_component(name ${file} NAME)
    string(APPEND text "        EmbeddedFile{\"${name}\", R\"~embed~(${content})~embed~\"},\n")
endforeach()
string(APPEND text "    };\n    return kFiles;\n}\n\n}  // namespace tinsmith\n")
file(WRITE ${made} "${text}")
