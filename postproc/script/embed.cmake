# Write OUT, a C source with null-terminated arrays; HEADER declares them.
#
#   FILES    names in FOLDER, "page.css,report.html": arrays post_page_css, post_report_html
#   MODULES  names in SCRIPTS, "numbers,axes": one script, array post_NAME
#
# A page needs one script without addresses, so each module becomes a function of its own scope. Its
# import statements take from the modules before it, its export statement is what it returns. Both
# have braces: import {a, b} from "./numbers.js"; export {c};
set(text "/* Made by embed.cmake. */\n#include \"${HEADER}\"\n")

function(shb_array name hex)
  string(REGEX REPLACE "(................................)" "\\1\n" hex "${hex}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "(char)0x\\1," hex "${hex}")
  set(text "${text}const char post_${name}[] = {\n${hex}0};\n" PARENT_SCOPE)
endfunction()

string(REPLACE "," ";" FILES "${FILES}")
foreach(file IN LISTS FILES)
  string(REPLACE "." "_" name ${file})
  file(READ ${FOLDER}/${file} hex HEX)
  shb_array(${name} "${hex}")
endforeach()

set(script "\"use strict\";\n")
string(REPLACE "," ";" MODULES "${MODULES}")
foreach(module IN LISTS MODULES)
  file(READ ${SCRIPTS}/${module}.js body)
  string(REGEX REPLACE "import ({[^}]*}) from \"\\./([a-z_]+)\\.js\";" "const \\1 = module_\\2;"
    body "${body}")
  string(REGEX REPLACE "export ({[^}]*});" "return \\1;" body "${body}")
  string(APPEND script "const module_${module} = (() => {\n${body}})();\n")
endforeach()
file(WRITE ${OUT}.js "${script}")
file(READ ${OUT}.js hex HEX)
shb_array(${NAME} "${hex}")
file(WRITE ${OUT} "${text}")
