" Specifications of tumato-symbolic.
if exists("b:current_syntax")
  finish
endif
syntax case match
syntax match tumatoName "\<\h[A-Za-z0-9_{}]*\>"
syntax match tumatoNumber "[+-]\?\<\d\+\>"
syntax keyword tumatoOperator AND OR NOT IF THEN IFONLYIF
syntax match tumatoBlock "\<\(BEGIN\|END\)\(\s\+\(STATE\s\+VECTOR\|STATE\s\+RULES\|REACTION\s\+RULES\|ALIASES\|RESOURCES\|ACTIONS\|ASSUMPTIONS\|START\|GOALS\|CONFIG\)\)\?\>"
syntax match tumatoDeclaration "\<\(state\|define\|action\|resource\)\>\ze\s\+\h"
syntax match tumatoDeclaration "\<can\s\+be\>\|\<as\>"
syntax match tumatoEntry "\<\(duration\|cost\|preconditions\|effects\|rule\|severity\|assume\|start\|goal\|max_plan_length\|effect_ordering\|restoration\)\>\ze\s*:"
syntax match tumatoEntry "\<\(controlled\s\+resources\|nominal\s\+effects\|alternative\s\+effects\|goal\s\+type\)\>\ze\s*:"
syntax match tumatoSetting "\(:\s*\)\@<=\<\(priority\|constraint\|any\|first\|one_step\|bounded\|fair\|at_start\|throughout\)\>\ze\s*$"
syntax match tumatoCopies "\<\(all\|some\|exactly\s\+one\|for\)\>\ze\s\+\h\w*\s\+in\>"
syntax match tumatoCopies "\<end\s\+for\>\|\<\(when\|then\|where\)\>"
syntax match tumatoComparison "\<is\(\s\+not\)\?\>\|\<\(not\s\+\)\?in\>\|<=\|>=\|!=\|[<>=]\|\<executing\>"
syntax keyword tumatoConstant true false none
syntax match tumatoComment "//.*$" contains=@Spell
syntax region tumatoComment start="/\*" end="\*/" contains=@Spell
highlight default link tumatoBlock Structure
highlight default link tumatoDeclaration Type
highlight default link tumatoEntry Statement
highlight default link tumatoSetting Constant
highlight default link tumatoCopies Repeat
highlight default link tumatoOperator Operator
highlight default link tumatoComparison Operator
highlight default link tumatoConstant Constant
highlight default link tumatoNumber Number
highlight default link tumatoName Identifier
highlight default link tumatoComment Comment
let b:current_syntax = "tumato"
