" Comments, and the layout of `tumato-sym format` for `gq`.
if exists("b:did_ftplugin")
  finish
endif
let b:did_ftplugin = 1
setlocal commentstring=//\ %s comments=s1:/*,mb:*,ex:*/,:// shiftwidth=2 expandtab
setlocal formatprg=tumato-sym\ format\ -
let b:undo_ftplugin = "setlocal commentstring< comments< shiftwidth< expandtab< formatprg<"
