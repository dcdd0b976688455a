// The processes of a Nextflow file and the labels of their blocks: parsed as Groovy, which Nextflow's language is.
import org.codehaus.groovy.ast.CodeVisitorSupport
import org.codehaus.groovy.ast.expr.*
import org.codehaus.groovy.control.*
def unit = new CompilationUnit()
unit.addSource(new File(args[0]))
unit.compile(Phases.CONVERSION)
unit.AST.modules[0].statementBlock.visit(new CodeVisitorSupport() {
  void visitMethodCallExpression(MethodCallExpression call) {
    if (call.methodAsString == 'process') {
      def named = call.arguments.expressions[0]
      println 'process ' + named.methodAsString + ': ' + named.arguments.expressions[0].code.statements.collectMany { it.statementLabels ?: [] }.unique().join(' ')
    } else super.visitMethodCallExpression(call)
  }
})
