;;; tumato-mode.el --- Specifications of tumato-symbolic  -*- lexical-binding: t -*-

;; Colours, comments, and `tumato-sym lsp` for eglot (part of Emacs 29, a package for 28).

;;; Code:

(defconst tumato-keywords
  '("AND" "OR" "NOT" "IF" "THEN" "IFONLYIF" "BEGIN" "END" "STATE" "VECTOR" "ALIASES" "RESOURCES" "ACTIONS" "REACTION"
    "RULES" "ASSUMPTIONS" "START" "GOALS" "CONFIG" "state" "can" "be" "define" "as" "resource" "action" "duration" "cost"
    "controlled" "resources" "preconditions" "nominal" "alternative" "effects" "rule" "severity" "assume" "start" "goal"
    "type" "priority" "constraint" "when" "then" "max_plan_length" "effect_ordering" "any" "first" "restoration"
    "one_step" "bounded" "fair" "at_start" "throughout" "for" "end" "in" "where" "all" "some" "exactly" "one" "is" "not"
    "executing")
  "The words of the language; where a name may stand, they may be names.")

(defconst tumato-constants '("true" "false" "none"))

;;;###autoload
(define-derived-mode tumato-mode prog-mode "Tumato"
  "Specifications of robot policies."
  (let ((table (syntax-table)))
    (modify-syntax-entry ?/ ". 124b" table)
    (modify-syntax-entry ?* ". 23" table)
    (modify-syntax-entry ?\n "> b" table)
    (modify-syntax-entry ?_ "w" table))
  (setq-local comment-start "// " comment-end "" indent-tabs-mode nil)
  (setq-local font-lock-defaults
              (list (list (cons (regexp-opt tumato-keywords 'words) 'font-lock-keyword-face)
                          (cons (regexp-opt tumato-constants 'words) 'font-lock-constant-face)))))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.\\(tum\\|tmt\\)\\'" . tumato-mode))

(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '(tumato-mode . ("tumato-sym" "lsp"))))

(provide 'tumato-mode)
;;; tumato-mode.el ends here
