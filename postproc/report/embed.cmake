# Write OUT, a C source with the files of FOLDER named in FILES ("page.css,page.js") as
# null-terminated arrays post_page_css, post_page_js. HEADER declares them.
set(text "/* Made by embed.cmake. */\n#include \"${HEADER}\"\n")
string(REPLACE "," ";" FILES "${FILES}")
foreach(file IN LISTS FILES)
  string(REPLACE "." "_" name ${file})
  file(READ ${FOLDER}/${file} hex HEX)
  string(REGEX REPLACE "(................................)" "\\1\n" hex "${hex}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "(char)0x\\1," hex "${hex}")
  string(APPEND text "const char post_${name}[] = {\n${hex}0};\n")
endforeach()
file(WRITE ${OUT} "${text}")
