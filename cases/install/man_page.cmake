# Makes a manual page from what a program prints itself, so the two cannot differ.
#   cmake -DPROGRAM=path -DARGUMENT=--help -DNAME=shroudhb -DSECTION=1 -DBRIEF=text -DVERSION=0.2.0
#         -DOUT=page.1 -P man_page.cmake
separate_arguments(ARGUMENT)
execute_process(COMMAND ${PROGRAM} ${ARGUMENT} OUTPUT_VARIABLE text RESULT_VARIABLE code)
if(code)
  message(FATAL_ERROR "${PROGRAM} ${ARGUMENT}: ended with ${code}")
endif()
# In roff a backslash escapes, a hyphen is not a minus sign, and a leading . or ' is a request.
string(REPLACE "\\" "\\e" text "${text}")
string(REPLACE "-" "\\-" text "${text}")
string(REGEX REPLACE "(^|\n)([.'])" "\\1\\\\&\\2" text "${text}")
string(REPLACE "-" "\\-" brief "${BRIEF}")
string(TOUPPER "${NAME}" title)
file(WRITE ${OUT} ".TH ${title} ${SECTION} \"\" \"shroudhb ${VERSION}\" \"shroudhb\"
.SH NAME
${NAME} \\- ${brief}
.SH DESCRIPTION
.nf
${text}.fi
.SH SEE ALSO
.BR shroudhb (1),
.BR shroudhb\\-case (5),
.BR shroudhb\\-study (5)
")
